"""The command `orbitrace export`. What is imported here is small, so that --help is quick."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..completion import branch_files
from ..options import DONE, count, tell_written

Source = Annotated[
    str,
    typer.Argument(
        metavar="BRANCH", help="A branch.nc, or the directory that has it.", autocompletion=branch_files
    ),
]
File = Annotated[
    Path,
    typer.Argument(metavar="FILE", help="What to write: .csv, .mat (MATLAB), .h5 (HDF5) or .uff (UFF58)."),
]
Samples = Annotated[str, typer.Option("--samples", metavar="N", help="Values of each signal over a period.")]


def export(branch: Source, file: File, samples: Samples = "256") -> int:
    """Write a traced branch for another program: its points and its orbits over a period, in SI units."""
    import periodic as per
    from symbolic.scenes.errors import InputError, refused

    path = Path(branch)
    number = count("--samples", samples)
    assert number is not None
    try:
        found = per.Branch.load(path / "branch.nc" if path.is_dir() else path)
        files = per.export(found, file, samples=number)
    except per.BranchFileError as error:
        raise refused("BRANCH", branch, f"a branch that can be read ({error})") from error
    except ModuleNotFoundError as error:
        raise InputError.said(f"FILE is {file}; {error}") from error
    except ValueError as error:
        said = str(error).replace("path is", "FILE is").replace("samples is", "--samples is")
        raise InputError.said(said) from None
    except OSError as error:
        allowed = "it must be a file that can be written"
        raise InputError("FILE", f'is "{file}" ({error.strerror})', allowed) from error
    tell_written(files)
    return DONE
