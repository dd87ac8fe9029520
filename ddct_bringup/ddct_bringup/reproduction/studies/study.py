"""What a study is: a table that closed-loop runs make of predictive controllers."""

from collections.abc import Callable
from dataclasses import dataclass

from ddct_plant.program.table import Table


@dataclass(frozen=True)
class Study(Table):
    """A table, and what to know when reading it."""

    remarks: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, object]:
        """Return the table with one mapping per row."""
        rows = [dict(zip(self.headers, row, strict=True)) for row in self.rows]
        return {'title': self.title, 'rows': rows, 'remarks': list(self.remarks)}


StudyFunction = Callable[[], Study]
