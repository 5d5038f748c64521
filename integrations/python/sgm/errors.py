"""What goes wrong, as exceptions with places in the text."""
from __future__ import annotations

import json
import re
from typing import NamedTuple, Tuple

_PLACED = re.compile(r"^(.*?):(\d+):(\d+): (?:error: )?", re.DOTALL)


class Diagnostic(NamedTuple):
    """A problem: where (line 0: nowhere; columns count bytes from 1), a sentence, and the fix where it has one."""

    severity: str  # "error" or "warning"
    message: str
    hint: str = ""
    file: str = ""
    line: int = 0
    column: int = 0
    end_line: int = 0
    end_column: int = 0

    @classmethod
    def _read(cls, text: str) -> Tuple[Diagnostic, ...]:
        return tuple(
            cls(entry["severity"], entry["message"], entry.get("hint") or "", entry.get("file") or "",
                entry.get("line") or 0, entry.get("column") or 0, entry.get("endLine") or 0,
                entry.get("endColumn") or 0)
            for entry in json.loads(text))


class Error(Exception):
    """What the library refuses or couldn't do. `diagnostics` say where, as far as a place is known."""

    def __init__(self, message: str, diagnostics: Tuple[Diagnostic, ...] = ()) -> None:
        super().__init__(message)
        self.diagnostics = diagnostics


class GrammarError(Error):
    """The grammar, a value for it or a file is wrong."""


class UsageError(Error, ValueError):
    """An argument names or means nothing."""


class BudgetError(Error):
    """More shapes, time or memory than is allowed."""


class Cancelled(Error):
    """The work was cancelled."""


class InternalError(Error):
    """A part of the installation is missing or fails."""


_KINDS = {"usage": UsageError, "budget": BudgetError, "cancelled": Cancelled, "internal": InternalError}


def _made(kind: str, message: str) -> Error:
    placed = _PLACED.match(message)
    diagnostics: Tuple[Diagnostic, ...] = ()
    if placed:
        file, line, column = placed.groups()
        sentence = message[placed.end():]
        diagnostics = (Diagnostic("error", sentence, "", file, int(line), int(column), int(line), int(column)),)
    return _KINDS.get(kind, GrammarError)(message, diagnostics)


def _made_of_diagnostics(rendered: str, text: str) -> Error:
    return GrammarError(rendered.rstrip("\n"), Diagnostic._read(text))
