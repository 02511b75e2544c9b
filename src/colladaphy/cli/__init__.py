"""The command line: a module a command, thin; everything is done by the library."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import NoReturn

import click

from colladaphy import __version__
from colladaphy.cli.console import EXIT_FINDINGS, EXIT_INTERNAL, EXIT_IO, note, say_findings
from colladaphy.cli.group import LazyGroup
from colladaphy.errors import ColladaError, ConfigurationError, InputError, OutputError

__all__ = ["group", "main"]


@click.command(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, "-V", "--version", message="colladaphy %(version)s")
def group() -> None:
    """Strict COLLADA 1.5 Physics: check, mend, convert, simulate and archive rigid body scenes.

    A file named - is standard input or output. The exit code is 0 when all is well, 1 when there
    are findings that make a document invalid, 2 for wrong usage and for files that cannot be read
    or written.
    """


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run a command and exit: 0 well, 1 findings, 2 usage or files, 3 a fault of ours."""
    # Nothing here multiplies large matrices, and numpy's library for that starts a thread a core
    # when it is imported: for a small file these take longer than all the rest.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a name may hold what the console cannot show
            stream.reconfigure(errors="backslashreplace")
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run a command; every error becomes a message and an exit code, never a traceback."""
    try:
        result = group.main(arguments, prog_name="colladaphy", standalone_mode=False)
        if sys.stdout is not None:  # it may be closed
            sys.stdout.flush()
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except (click.Abort, KeyboardInterrupt):
        note("Stopped.")
        return 130
    except BrokenPipeError:  # the reader of our output has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return EXIT_FINDINGS
    except ColladaError as error:
        if error.findings:
            say_findings(error.findings)
        else:
            note(f"error: {error}")
        usage = isinstance(error, ConfigurationError | InputError | OutputError)
        return EXIT_IO if usage else EXIT_FINDINGS
    except OSError as error:
        note(f"error: Something could not be read or written: {error.strerror or error}.")
        return EXIT_IO
    except MemoryError:
        note("error: There is not enough memory for this.")
        return EXIT_IO
    except Exception as error:
        if os.environ.get("COLLADAPHY_DEBUG"):
            raise
        note(f"error: A fault in colladaphy: {type(error).__name__}: {error}")
        note("    Please report it with the file and the command; COLLADAPHY_DEBUG=1 shows more.")
        return EXIT_INTERNAL
    return result if isinstance(result, int) else 0
