# SPDX-License-Identifier: Apache-2.0
"""The CSV tables of a run: what the evaluation programs wrote, numbers as numbers."""
import csv
import math
import pathlib


def number(text):
    """A cell: int or float where it is one, else the text as it is."""
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return float(text)
    except ValueError:
        return text


class Table:
    """Rows as dicts. A column that is not there is an error that names table and column."""

    def __init__(self, name, columns, rows):
        self.name, self.columns, self.rows = name, columns, rows

    def where(self, **wanted):
        return Table(self.name, self.columns,
                     [r for r in self.rows if all(self._value(r, k) == v for k, v in wanted.items())])

    def column(self, name):
        return [self._value(r, name) for r in self.rows]

    def values(self, name):
        """The different values of a column, in the order in which they first appear."""
        return list(dict.fromkeys(self.column(name)))

    def sorted_by(self, *names):
        return Table(self.name, self.columns, sorted(self.rows, key=lambda r: tuple(self._value(r, n) for n in names)))

    def _value(self, row, column):
        if column not in row:
            raise KeyError(f"{self.name}.csv has no column '{column}'; it has {', '.join(self.columns)}")
        return row[column]

    def __len__(self):
        return len(self.rows)


def read_table(path):
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.reader(file)
        columns = next(reader, [])
        rows = []
        for line, cells in enumerate(reader, 2):
            if len(cells) != len(columns):
                raise ValueError(f"{path}:{line}: {len(cells)} cells under {len(columns)} columns; was the program stopped?")
            rows.append(dict(zip(columns, map(number, cells))))
    return Table(pathlib.Path(path).stem, columns, rows)


class Run:
    """Every table of a folder by its name, and all bars together."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.tables, self.bars = {}, []
        for path in sorted(self.folder.glob("*.csv")):
            table = read_table(path)
            if path.name.endswith(".bars.csv"):
                program = path.name[:-len(".bars.csv")]
                self.bars += [{"program": program, **row} for row in table.rows]
            else:
                self.tables[table.name] = table

    def table(self, name):
        """None where the program that writes it was not run, or wrote no row."""
        table = self.tables.get(name)
        return table if table is not None and len(table) > 0 else None


def jsonable(value):
    """JSON has no NaN and no infinity: they become null."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
