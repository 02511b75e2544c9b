"""What is the same in a finding when lines move."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from hashlib import sha256

from colladaphy.findings import Finding

__all__ = ["Key", "fingerprints", "key_of", "moved"]

#: Code, file, path, attribute and message of a finding, without line numbers.
Key = tuple[str, str, str, str, str]

_LINE = re.compile(r"\b(lines?) \d+(?:, \d+)*(?: and \d+)?")
_POSITION = re.compile(r"\[\d+\]")


def key_of(finding: Finding, file: str) -> Key:
    """What identifies a finding in a file, by its element and not by its line."""
    message = _LINE.sub(r"\1", finding.message)
    return finding.code, file, finding.path or "", finding.attribute or "", message


def moved(key: Key) -> Key:
    """The same without positions among siblings, which change when one is added before."""
    code, file, path, attribute, message = key
    return code, file, _POSITION.sub("", path), attribute, message


def fingerprints(findings: Iterable[tuple[Finding, str]]) -> Iterator[str]:
    """A fingerprint of each finding and file; the same ones are numbered, so that each is unique.

    They are the same in every run and on every machine, wherever the lines of a file move.
    """
    seen: Counter[Key] = Counter()
    for finding, file in findings:
        key = key_of(finding, file)
        seen[key] += 1
        yield sha256("\0".join((*key, str(seen[key]))).encode("utf-8", "replace")).hexdigest()[:32]
