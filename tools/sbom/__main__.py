# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Bill of materials: what is installed, and what the wheels bundle, as CycloneDX JSON.

It needs no network. Packages and versions come from the locks. What the wheels bundle comes from
the files that they have installed: shared libraries, with the version in the name of the file, and
OpenSSL, by the version that stands in each of them.
"""

import argparse
import json
import mmap
import re
import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
LOCKS = {
    'workspace': 'required',
    'uv': 'required',
    'fmu': 'optional',
    'gym': 'optional',
    'tune': 'optional',
    'bench': 'excluded',
    'fuzz': 'excluded',
    'site': 'excluded',
    'test': 'excluded',
}
"""Scope of CycloneDX by lock, the widest first: a package in two of them has the first."""
_PIN = re.compile(r'^([\w.-]+)==(\S+)', re.MULTILINE)
_LIBRARY = re.compile(r'lib([\w+-]+?)(?:-[0-9a-f]{8,})*\.so(?:\.(\d+(?:\.\d+)*[a-z]?))?')
"""Name and version in the name of a library; auditwheel adds digits of a hash, or of two."""
_OPENSSL = re.compile(rb'OpenSSL (\d+\.\d+\.\d+[a-z]?)\s+(?:FIPS )?\s*\d{1,2} \w{3} \d{4}')
_OF_OPENSSL = ('crypto', 'ssl')
_LONGEST_LICENCE = 60
"""Longest text of a licence's name; a longer one is the licence itself."""


@dataclass(frozen=True, order=True)
class Bundled:
    """A library inside a wheel."""

    name: str
    version: str


def document() -> dict[str, Any]:
    """Return the content of the file; the same for the same locks and environment."""
    components = [_component(*each) for each in _packages()]
    text = json.dumps(components, sort_keys=True)
    return {
        'bomFormat': 'CycloneDX',
        'specVersion': '1.5',
        'serialNumber': uuid.uuid5(uuid.NAMESPACE_URL, text).urn,
        'version': 1,
        'metadata': {
            'component': {
                'type': 'application',
                'bom-ref': 'ddct',
                'name': 'ddct',
                'version': distribution('ddct_plant').version,
                'licenses': [{'license': {'id': 'Apache-2.0'}}],
            }
        },
        'components': components,
        'dependencies': [{'ref': 'ddct', 'dependsOn': [each['bom-ref'] for each in components]}],
    }


def _packages() -> Iterator[tuple[str, str, str]]:
    """Yield name, version and scope of every package in the locks, sorted, each once."""
    if unknown := {file.stem for file in (ROOT / 'locks').glob('*.txt')} - set(LOCKS):
        raise SystemExit(f'tools/run sbom: no scope is given for {", ".join(sorted(unknown))}')
    found: dict[tuple[str, str], str] = {}
    for lock, scope in LOCKS.items():
        text = (ROOT / 'locks' / f'{lock}.txt').read_text(encoding='utf-8')
        for name, version in _PIN.findall(text):
            found.setdefault((name, version), scope)
    for (name, version), scope in sorted(found.items()):
        yield name, version, scope


def _component(name: str, version: str, scope: str) -> dict[str, Any]:
    """Return the component of a package, with what its wheel bundles where it is installed."""
    component: dict[str, Any] = {
        'type': 'library',
        'bom-ref': f'pkg:pypi/{name}@{version}',
        'name': name,
        'version': version,
        'scope': scope,
        'purl': f'pkg:pypi/{name}@{version}',
    }
    try:
        installed = distribution(name)
    except PackageNotFoundError:  # an extra, or of another Python
        return component
    if licence := _licence(installed):
        component['licenses'] = [{'license': {'name': licence}}]
    if bundled := _without_short_names(set(_bundled_in(installed))):
        component['components'] = [
            {
                'type': 'library',
                'bom-ref': f'{component["purl"]}#{each.name}@{each.version}',
                'name': each.name,
                'version': each.version,
                'purl': f'pkg:generic/{each.name}@{each.version}',
            }
            for each in bundled
        ]
    return component


def _licence(installed: Distribution) -> str:
    """Return the licence that a package states in its metadata, empty for none in short."""
    about = installed.metadata
    stated = [
        each for key in ('License-Expression', 'License') for each in about.get_all(key) or ('',)
    ]
    stated += [
        each.rpartition(' :: ')[2]
        for each in about.get_all('Classifier') or ()
        if each.startswith('License :: ')
    ]
    short = [each for each in stated if each and len(each) <= _LONGEST_LICENCE]
    return short[0] if short else ''


def _bundled_in(installed: Distribution) -> Iterator[Bundled]:
    """Yield the libraries that a wheel has brought along, and the versions of OpenSSL in them."""
    for record in installed.files or ():
        found = _LIBRARY.fullmatch(record.name)
        if '.so' not in record.suffixes:
            continue
        path = Path(str(installed.locate_file(record)))
        for version in _openssl_in(path):
            yield Bundled('openssl', version)
        own = record.parent.name.endswith('.libs') or (found and '.' in (found[2] or ''))
        if found and own:
            name = 'openssl' if found[1] in _OF_OPENSSL else found[1]
            yield Bundled(name, found[2] or 'unknown')


def _without_short_names(libraries: set[Bundled]) -> list[Bundled]:
    """Return the libraries but those whose version is the beginning of another's: links to it."""
    return sorted(
        each
        for each in libraries
        if not any(
            other.name == each.name and other.version.startswith(f'{each.version}.')
            for other in libraries
        )
    )


def _openssl_in(path: Path) -> Iterator[str]:
    """Yield the versions of OpenSSL whose text is in a file."""
    if not path.is_file() or not path.stat().st_size:
        return
    with path.open('rb') as file, mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ) as content:
        for version in sorted({found[1] for found in _OPENSSL.finditer(content)}):
            yield version.decode()


def main() -> int:
    """Write the file that is named on the command line."""
    parser = argparse.ArgumentParser(description='Write what is installed as CycloneDX JSON.')
    parser.add_argument('file', type=Path)
    file: Path = parser.parse_args().file
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(document(), indent=2) + '\n', encoding='utf-8')
    print(file)
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
