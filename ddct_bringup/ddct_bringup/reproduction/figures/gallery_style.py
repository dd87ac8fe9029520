"""How the gallery looks: on a light and on a dark screen, on a phone and on paper."""

STYLE = """
:root { color-scheme: light dark; --paper: #fff; --ink: #1c1c1c; --faint: #5c5c5c;
  --line: #d8d8d8; --link: #005a8d; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #171717; --ink: #e4e4e4; --faint: #a6a6a6; --line: #3d3d3d; --link: #6db8e8; }
  img { filter: invert(0.91) hue-rotate(180deg); }
}
body { font: 1rem/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  max-width: 70rem; margin: 0 auto; padding: 1rem; }
header p { max-width: 46rem; }
h1 { font-size: 1.6rem; line-height: 1.2; }
h2 { font-size: 1.25rem; border-bottom: 1px solid var(--line); padding-bottom: .3rem;
  margin-top: 2.5rem; }
nav { display: flex; flex-wrap: wrap; gap: .4rem 1.2rem; }
a { color: var(--link); }
figure { margin: 1.5rem 0; }
img { display: block; width: 100%; height: auto; }
figcaption { overflow-wrap: break-word; }
figcaption b { display: block; margin: .4rem 0; }
.absent { margin: .5rem 0; color: var(--faint); }
sub, sup { line-height: 0; font-size: .75em; }
@media (min-width: 52rem) {
  figure { display: grid; grid-template-columns: 8fr 5fr; gap: 1.5rem; }
}
@media print {
  :root { --paper: #fff; --ink: #000; --faint: #444; --line: #999; }
  body { max-width: none; padding: 0; font-size: 9pt; }
  nav { display: none; }
  figure { display: grid; grid-template-columns: 12cm 1fr; gap: .5cm; break-inside: avoid;
    margin: .3cm 0; }
  img { filter: none; }
  h2, .absent { break-after: avoid; }
}
"""
