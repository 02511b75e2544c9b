"""``colladaphy.toml`` and ``[tool.colladaphy]``: what is reported, of which files, how gravely."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NoReturn

from colladaphy.errors import ConfigurationError
from colladaphy.findings import Rule, Severity
from colladaphy.validation import rules
from colladaphy.validation.patterns import Patterns
from colladaphy.validation.settings import ALL, Settings

__all__ = ["Configuration", "Configurations", "known_names", "read_configuration"]

_OWN = "colladaphy.toml"
_SHARED = "pyproject.toml"
_LEVELS = [str(severity) for severity in Severity]
_COLLADA_14 = ("error", "warning", "ignore")


@dataclass(frozen=True, slots=True)
class Configuration:
    """What a configuration says; patterns and files are relative to its folder."""

    folder: Path | None = None
    file: Path | None = None
    settings: Settings = field(default_factory=Settings)
    exclude: Patterns = field(default_factory=Patterns)
    baseline: Path | None = None
    per_file: tuple[tuple[Patterns, Mapping[str, Any]], ...] = ()

    def excludes(self, path: Path) -> bool:
        """Whether a file is left out where a folder is searched."""
        return self.exclude.match(path, self.folder)

    def settings_of(self, path: Path | None) -> Settings:
        """The settings of one file; later entries of ``per-file`` win."""
        settings = self.settings
        for patterns, keys in self.per_file:
            if path is not None and patterns.match(path, self.folder):
                settings = settings.changed(keys)
        return settings


class Configurations:
    """The configuration of each file: the first that its folder or one above it has."""

    def __init__(self, fixed: Configuration | None = None) -> None:
        """`fixed` is that of all files, where one was named or none is wanted."""
        self._fixed = fixed
        self._known: dict[Path, Configuration] = {}

    def of(self, folder: Path) -> Configuration:
        """The configuration for files of a folder. ConfigurationError where it is faulty."""
        if self._fixed is not None:
            return self._fixed
        folder = folder.resolve()
        passed = []
        found = Configuration()
        for above in (folder, *folder.parents):
            if above in self._known:
                found = self._known[above]
                break
            passed.append(above)
            here = _in_folder(above)
            if here is not None:
                found = here
                break
        for above in passed:
            self._known[above] = found
        return found


def _in_folder(folder: Path) -> Configuration | None:
    own = folder / _OWN
    if own.is_file():
        return read_configuration(own)
    shared = folder / _SHARED
    if shared.is_file() and b"colladaphy" in _bytes(shared):
        return _of_pyproject(shared)
    return None


def read_configuration(file: Path) -> Configuration:
    """Read a configuration; a ``pyproject.toml`` is read for its ``[tool.colladaphy]``.

    ConfigurationError where it cannot be read, or says what there is not.
    """
    if file.name == _SHARED:
        return _of_pyproject(file) or Configuration(file.resolve().parent, file)
    return _Reader(file, "").configuration(_table(file))


def _of_pyproject(file: Path) -> Configuration | None:
    tool = _table(file).get("tool", {})
    if not isinstance(tool, dict) or "colladaphy" not in tool:
        return None
    reader = _Reader(file, "tool.colladaphy")
    return reader.configuration(reader.mapping("", tool["colladaphy"]))


def _bytes(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        message = f"The configuration cannot be read: {error.strerror or error}."
        raise ConfigurationError(rules.UNREADABLE.at(message=message, file=str(file))) from None


def _table(file: Path) -> dict[str, Any]:
    import tomllib

    data = _bytes(file)
    try:
        return tomllib.loads(data.decode("utf-8"))
    except ValueError as error:  # of TOML and of UTF-8
        message = f"The configuration is not TOML: {error}."
        raise ConfigurationError(rules.SYNTAX.at(message=message, file=str(file))) from None


class _Reader:
    """Takes the values of a table apart, and says where one is not as it should be."""

    def __init__(self, file: Path, table: str) -> None:
        self._file = file
        self._table = table

    def configuration(self, table: Mapping[str, Any]) -> Configuration:
        folder = self._file.resolve().parent
        settings = self._settings(table, "", ("exclude", "baseline", "per-file"))
        baseline = table.get("baseline")
        if baseline is not None and not (isinstance(baseline, str) and baseline):
            self._wrong("baseline", baseline, "the name of a file")
        files = self.mapping("per-file", table.get("per-file", {}))
        return Configuration(
            folder,
            self._file,
            replace(Settings(), **settings),
            self._patterns("exclude", self._texts("exclude", table.get("exclude", []))),
            folder / baseline if baseline else None,
            tuple(
                (self._patterns("per-file", [pattern]), self._of_file(pattern, keys))
                for pattern, keys in files.items()
            ),
        )

    def _of_file(self, pattern: str, keys: Any) -> Mapping[str, Any]:
        key = f'per-file."{pattern}"'
        return self._settings(self.mapping(key, keys), f"{key}.", ())

    def _settings(
        self, table: Mapping[str, Any], prefix: str, others: tuple[str, ...]
    ) -> dict[str, Any]:
        """The settings that a table holds; an error for a key that is none of them."""
        readers: dict[str, Callable[[str, Any], Any]] = {
            "select": self._names,
            "ignore": self._names,
            "severity": self._severities,
            "collada-14": self._collada_14,
            "fail-level": self._level,
        }
        found = {}
        for key, value in table.items():
            if key in readers:
                found[key.replace("-", "_")] = readers[key](f"{prefix}{key}", value)
            elif key not in others:
                self._unknown(f"{prefix}{key}", key, [*readers, *others])
        return found

    def mapping(self, key: str, value: Any) -> dict[str, Any]:
        if not isinstance(value, dict):
            self._wrong(key, value, "a table")
        return value

    def _texts(self, key: str, value: Any) -> list[str]:
        if not isinstance(value, list) or not all(isinstance(text, str) for text in value):
            self._wrong(key, value, "a list of strings")
        return value

    def _names(self, key: str, value: Any) -> tuple[str, ...]:
        return known_names(self._texts(key, value), lambda rule, message: self._fail(rule, message))

    def _severities(self, key: str, value: Any) -> dict[str, Severity]:
        table = self.mapping(key, value)
        known_names(table, lambda rule, message: self._fail(rule, message))
        return {name: self._level(f"{key}.{name}", level) for name, level in table.items()}

    def _level(self, key: str, value: Any) -> Severity:
        if value not in _LEVELS:
            self._wrong(key, value, f"one of {', '.join(_LEVELS)}")
        return Severity(value)

    def _collada_14(self, key: str, value: Any) -> Severity | None:
        if value not in _COLLADA_14:
            self._wrong(key, value, f"one of {', '.join(_COLLADA_14)}")
        return None if value == "ignore" else Severity(value)

    def _patterns(self, key: str, texts: Iterable[str]) -> Patterns:
        try:
            return Patterns.of(texts)
        except ValueError as error:
            return self._fail(rules.WRONG_VALUE, f"{self._name(key)}: {error}.")

    def _name(self, key: str) -> str:
        return ".".join(part for part in (self._table, key) if part)

    def _wrong(self, key: str, value: Any, wanted: str) -> NoReturn:
        self._fail(rules.WRONG_VALUE, f"{self._name(key)} is {value!r}; it must be {wanted}.")

    def _unknown(self, key: str, name: str, known: list[str]) -> NoReturn:
        from difflib import get_close_matches

        close = get_close_matches(name, known, 1)
        hint = f" Did you mean {close[0]!r}?" if close else f" There are {', '.join(known)}."
        self._fail(rules.UNKNOWN_KEY, f"There is no key {self._name(key)!r}.{hint}")

    def _fail(self, rule: Rule, message: str) -> NoReturn:
        raise ConfigurationError(rule.at(message=message, file=str(self._file)))


def known_names(names: Iterable[str], fail: Callable[[Rule, str], NoReturn]) -> tuple[str, ...]:
    """Codes and beginnings of codes; `fail` is called with what is wrong with the first wrong one.

    A beginning ends before a hyphen, so that ``schema-missing`` stands for all codes of that kind.
    """
    from colladaphy.validation.catalogue import all_rules, similar_codes

    found = tuple(names)
    codes = [f"{rule.code}-" for rule in all_rules()] if any(n != ALL for n in found) else []
    for name in found:
        if name != ALL and not any(code.startswith(f"{name}-") for code in codes):
            close = similar_codes(name)
            hint = f" Did you mean {' or '.join(close)}?" if close else ""
            fail(rules.UNKNOWN_CODE, f"There is no code {name!r}.{hint}")
    return found
