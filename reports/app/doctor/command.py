"""The command `orbitrace doctor`. What is imported here is small, so that --help is quick."""

from __future__ import annotations

from typing import Annotated

import typer

from ..options import DONE, STOPPED_EARLY, tell

Json = Annotated[bool, typer.Option("--json", help="Print the same as JSON, and nothing else.")]


def doctor(as_json: Json = False) -> int:
    """Tell versions, compiler, threads and BLAS, and check some numbers, for two seconds.

    Exit code 0: all is well; 3: a number is wrong.
    """
    import json

    from ..doctor.machine import facts
    from ..doctor.numbers import checks
    from ..doctor.text import record, table

    found = facts()
    if not as_json:
        tell(*table(found))
    checked = checks()
    if as_json:
        typer.echo(json.dumps({**found, "checks": [record(check) for check in checked]}, indent=2))
    else:
        tell(*table({"numbers": {check.name: str(check) for check in checked}}))
    return DONE if all(check.right for check in checked) else STOPPED_EARLY
