"""Runs grainsweep from Python: its command line and the JSON that it promises, nothing else.

    import grainsweep

    grainsweep.run("beam.json", jobs=2)
    table = grainsweep.frame("beam.db", "beam")
    table.attrs["units"]["deflection"]

Needs the standard library; `frame` returns a pandas.DataFrame where pandas is installed, else a list of dicts with the
same `attrs`. The program is found by the variable GRAINSWEEP, beside this file, or on the search path.
"""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

try:
    import pandas
except ImportError:
    pandas = None

__all__ = ["Error", "Refused", "Broken", "Rows", "Study", "frame", "import_results", "predict", "query", "run", "window"]


class Error(Exception):
    """A command that did not do its work; `code` is its exit code."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code


class Refused(Error):
    """Exit code 2: the campaign file or an argument is wrong. The message names place, value and rule."""


class Broken(Error):
    """Exit code 3: disk full, database locked or damaged."""


class Rows(list):
    """List of dicts, in place of a pandas.DataFrame; `attrs` are those of the frame."""

    def __init__(self, rows=()):
        super().__init__(rows)
        self.attrs = {}

    def __getitem__(self, key):
        return [row[key] for row in self] if isinstance(key, str) else super().__getitem__(key)


def _program():
    named = os.environ.get("GRAINSWEEP")
    if named:
        return named
    here = pathlib.Path(__file__).resolve().parent
    # <prefix>/share/grainsweep/python, and a clone with its build.
    for beside in (here.parents[2] / "bin" / "grainsweep" if len(here.parents) > 2 else here, here.parents[1] / "build" / "grainsweep"):
        if beside.is_file() and os.access(beside, os.X_OK):
            return str(beside)
    found = shutil.which("grainsweep")
    if found is None:
        raise Error("there is no program 'grainsweep' on the search path; the variable GRAINSWEEP may name it", 127)
    return found


def _option(name, value):
    """Words of a command for keep_going=True, jobs=2, next=3, hold={"gap": "2 mm"}."""
    if value is None or value is False:
        return []
    dashed = "-j" if name == "jobs" else "--" + name.replace("_", "-")
    if value is True:
        return [dashed]
    if isinstance(value, dict):
        return [word for key, one in value.items() for word in (dashed, f"{key}={one}")]
    return [dashed, str(value)]


def _call(command, *arguments, codes=(0,), **options):
    """The one JSON value that a command prints."""
    words = [_program(), command, *map(str, arguments)]
    for name, value in options.items():
        words += _option(name, value)
    done = subprocess.run(words + ["--format", "json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode in codes:
        return json.loads(done.stdout)
    message = done.stderr.strip()
    try:
        message = json.loads(done.stdout)["error"]["message"]
    except (ValueError, KeyError, TypeError):
        pass
    kind = {2: Refused, 3: Broken}.get(done.returncode, Error)
    raise kind(message or f"grainsweep {command} ended with code {done.returncode}", done.returncode)


def _table(rows):
    if pandas is not None:
        return pandas.DataFrame(rows)
    return Rows(rows)


def run(config, db=None, jobs=None, **options):
    """Computes a campaign file and returns how the run ended: {"campaign", "database", "ending", "exit_code", ...}.

    `exit_code` is 0 if every case has an answer, and 1 if some have none. Further options are those of the command:
    max_cases=10, again="crashed", adopt="old", keep_going=True. Run again to resume.
    """
    return _call("run", config, codes=(0, 1), db=db, jobs=jobs, quiet=True, **options)


def import_results(results, config, db=None, **options):
    """Stores results that were computed elsewhere, with their origin, and returns what was taken.

    `results` is a CSV file, a list of dicts or a DataFrame: a column for each factor and observable, and `outcome`.
    Options: decimal="comma", ignore="remark", partial=True.
    """
    words = [str(config)] + ([str(db)] if db is not None else [])
    if isinstance(results, (str, os.PathLike)):
        return _call("import", results, *words, **options)
    with tempfile.TemporaryDirectory() as folder:
        return _call("import", _points_file(results, folder, "results.csv"), *words, **options)


def query(db, sql):
    """Rows of an SQL query, which cannot change the database."""
    return _table(_call("query", db, sql))


def frame(db, campaign):
    """One row per case: place in the design, outcome, factors and scalar observables; NaN or None where there is none.

    `attrs` has "units" and "meanings" by column, "campaign" and "database".
    """
    name = '"' + campaign.replace('"', '""') + '"'
    rows = _call("query", db, f"SELECT * FROM {name} ORDER BY point, replicate")
    of_scene = "JOIN campaign AS g USING (scene, revision) WHERE g.name = '" + campaign.replace("'", "''") + "'"
    told = _call(
        "query",
        db,
        f"SELECT p.name, p.unit, p.meaning FROM parameter AS p {of_scene} "
        f"UNION ALL SELECT p.name, p.unit, p.meaning FROM observable AS p {of_scene}",
    )
    table = _table(rows)
    columns = set(rows[0]) if rows else {one["name"] for one in told}
    told = [one for one in told if one["name"] in columns]
    table.attrs.update(
        campaign=campaign,
        database=str(db),
        units={**{"wall_seconds": "s"}, **{one["name"]: one["unit"] for one in told}},
        meanings={one["name"]: one["meaning"] for one in told},
    )
    return table


def _points_file(points, folder, name="points.csv"):
    """CSV of points: a list of dicts, or a DataFrame."""
    if pandas is not None and isinstance(points, pandas.DataFrame):
        points = points.to_dict("records")
    points = list(points)
    if not points:
        raise ValueError("at least one point is needed")
    file = pathlib.Path(folder) / name
    with open(file, "w", newline="") as stream:
        writer = csv.DictWriter(stream, fieldnames=list(points[0]))
        writer.writeheader()
        writer.writerows(points)
    return file


def predict(db, points, observable=None, campaign=None, **options):
    """Predictions at points (dicts by factor, or a DataFrame): inputs, mean, mean_error, scatter and further columns.

    `attrs["model"]` states on how many cases the model rests, and its error.
    """
    with tempfile.TemporaryDirectory() as folder:
        told = _call(
            "predict", db, points=_points_file(points, folder), observable=observable, campaign=campaign, **options
        )
    rows = [{**one["inputs"], **{key: value for key, value in one.items() if key != "inputs"}} for one in told["points"]]
    table = _table(rows)
    table.attrs.update(model=told["model"], observable=told["observable"], campaign=told["campaign"])
    return table


def window(db, where, **options):
    """The process window of a condition, as `window --format json` prints it.

    Options: maximize="force", risk=0.05, next=3, hold={"gap": "2 mm"}, campaign="beam".
    """
    return _call("window", db, where=where, **options)


class Study:
    """Cases that Python asks for one batch after the other: a campaign whose design is a list that grows.

    `campaign` is a campaign file or its object; its design is replaced by the list. Points of an earlier study of this
    name in the database are its first ones.

        study = Study("beam.json", db="beam_study.db")
        study.tell([{"force": 200, "length": 0.75}])     # computed, and returned with observables
        study.tell(study.ask(4, where="deflection <= 0.02", maximize="force"))
    """

    def __init__(self, campaign, db=None, folder=None, jobs=None):
        if isinstance(campaign, (str, os.PathLike)):
            folder = folder or pathlib.Path(campaign).resolve().parent
            campaign = json.loads(pathlib.Path(campaign).read_text())
        self._campaign = json.loads(json.dumps(campaign))
        for other in ("calibration", "convergence"):
            self._campaign.pop(other, None)
        self.name = self._campaign["campaign"]
        self.folder = pathlib.Path(folder or ".").resolve()
        self.db = pathlib.Path(db or f"{self.name}.db")
        self.factors = [factor["name"] for factor in self._campaign["factors"]]
        self._jobs = jobs
        self._rows = []
        if self.db.exists():
            stored = frame(self.db, self.name)
            rows = stored.to_dict("records") if pandas is not None else stored
            seen = {}
            for row in rows:
                seen.setdefault(row["point"], [row[name] for name in self.factors])
            self._rows = [seen[point] for point in sorted(seen)]

    def tell(self, points, **options):
        """Computes further points and returns their rows of the frame, in the order of the points."""
        if pandas is not None and isinstance(points, pandas.DataFrame):
            points = points.to_dict("records")
        rows = [[point[name] for name in self.factors] for point in points]
        first = len(self._rows)
        if not rows:
            return self._since(first) if first else _table([])
        self._campaign["design"] = {"kind": "list", "rows": self._rows + rows}
        # Files that the campaign names lie beside it.
        descriptor, file = tempfile.mkstemp(prefix=f".{self.name}-", suffix=".json", dir=self.folder)
        try:
            with os.fdopen(descriptor, "w") as stream:
                json.dump(self._campaign, stream, default=lambda number: number.item())  # numbers of NumPy
            self.last_run = run(file, db=self.db, jobs=self._jobs, **options)
        finally:
            os.unlink(file)
        self._rows += rows
        return self._since(first)

    def ask(self, count, where, **options):
        """The points that `window` proposes to run next, as dicts by factor; none where no further case would help."""
        told = window(self.db, where, campaign=self.name, next=count, **options)
        return [one["inputs"] for one in told["next"]]

    def frame(self):
        return frame(self.db, self.name)

    def _since(self, first):
        table = self.frame()
        if pandas is not None:
            later = table[table["point"] >= first].reset_index(drop=True)
            later.attrs.update(table.attrs)
            return later
        later = Rows(row for row in table if row["point"] >= first)
        later.attrs = table.attrs
        return later
