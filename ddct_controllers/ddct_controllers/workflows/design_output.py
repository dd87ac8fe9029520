"""Where a design goes: DIR/NAME.yaml, a controller's name for every program, and its charts."""

from pathlib import Path

from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.designed import DesignedController, load_designed, require_name
from ddct_controllers.registry import controller_names
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.output_file import write_text
from ddct_plant.models.parameters import DrivelineParameters


def require_free(name: str, folder: Path | None, *, overwrite: bool) -> None:
    """
    Check before the work that a design can be kept under this name; raise DdctError if not.

    `overwrite` replaces only a file that holds a designed controller.
    """
    require_name(name)
    if name in controller_names():
        raise ParameterError(f'--name {name} is taken by another controller: choose another')
    if folder is None:
        return
    path = design_path(folder, name)
    if path.exists():
        if not overwrite:
            raise DdctError(f'{path} exists already: choose another --name or add --overwrite')
        load_designed(str(path))


def design_path(folder: Path, name: str) -> Path:
    """Return where the controller called `name` goes."""
    return folder / f'{name}.yaml'


def write_design(
    folder: Path,
    designed: DesignedController,
    specifications: TimeSpecifications,
    parameters: DrivelineParameters,
) -> Path:
    """Write charts and, last, the controller; return its path. Raise DdctError on failure."""
    # matplotlib takes most of a second to load.
    from ddct_controllers.design.drawing.design_charts import write_design_charts

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DdctError(f'--out {folder}: cannot be made ({error.strerror})') from error
    write_design_charts(
        folder,
        designed.name,
        designed.transfer_function,
        designed.sampled(),
        specifications,
        parameters,
    )
    path = design_path(folder, designed.name)
    write_text(str(path), designed.to_yaml())
    return path
