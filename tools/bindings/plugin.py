"""The xsdata generator: dataclasses by xsdata's templates, codecs beside them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from xsdata.codegen.models import Class, Import
from xsdata.codegen.resolver import DependenciesResolver
from xsdata.formats.dataclass.generator import DataclassGenerator
from xsdata.formats.mixins import GeneratorResult
from xsdata.models.config import GeneratorConfig

from tools.bindings.columns import columns_module
from tools.bindings.common import PACKAGE, ancestry
from tools.bindings.model import Model, Record
from tools.bindings.modules import MARK, codec_module, package_module, package_stub, registry_module

# Modules whose name is not their schema file's.
RENAMED = {"collada": "document", "pe_profile": "pe"}
PROFILE = "pe"
# What annotations of fields are made of.
ANNOTATED = {"bool", "bytes", "dict", "float", "int", "list", "object", "str"}
RUNTIME = Path(__file__).parent / "runtime"


class BindingsGenerator(DataclassGenerator):
    """Renders a package of dataclass modules, codec modules and their tables.

    References to classes of another module are imported for annotations only, and at run time
    where a class derives from another or a default is a member of an enumeration.
    """

    def __init__(self, config: GeneratorConfig) -> None:
        super().__init__(config)
        self.stated: set[str] = set()
        self.records: dict[str, Record] = {}

    def normalize_packages(self, classes: list[Class]) -> None:
        """Put all modules into one package, named after the schema files."""
        super().normalize_packages(classes)
        for obj in classes:
            obj.package = PACKAGE
            obj.module = RENAMED.get(obj.module or "", obj.module)

    def render(self, classes: list[Class]) -> Iterator[GeneratorResult]:
        """Yield every file of the package."""
        model = Model(classes, self.filters)
        self.records = model.records
        self.stated = {
            qname
            for qname, record in model.records.items()
            if record.base is None and remembers(record, model)
        }
        modules = {obj.qname: obj.target_module for obj in classes}
        resolver = DependenciesResolver(registry=modules)
        lazy: dict[str, dict[str, str]] = {}
        root = Path.cwd() / PACKAGE
        by_module = sorted(classes, key=lambda obj: str(obj.module))
        for module, group in groupby(by_module, key=lambda obj: str(obj.module)):
            members = list(group)
            lazy[module] = {}
            source = self.render_area(resolver, members, model, lazy[module])
            yield GeneratorResult(root / f"{module}.py", module, source)
            records = [
                model.records[name]
                for name in resolver.class_list
                if name in {obj.qname for obj in members}
            ]
            yield GeneratorResult(
                root / f"{module}_codec.py", module, codec_module(module, records)
            )
            yield GeneratorResult(
                root / f"{module}_columns.py", module, columns_module(module, records, model)
            )
        records = list(model.records.values())
        yield GeneratorResult(root / "registry.py", "registry", registry_module(records, lazy))
        yield GeneratorResult(root / "__init__.py", "package", package_module(homes(records)))
        yield GeneratorResult(root / "__init__.pyi", "stub", package_stub(homes(records)))
        for path in sorted(RUNTIME.glob("*.py")):
            if path.stem in lazy:
                raise ValueError(f"the schema file {path.stem} has the name of a runtime module")
            source = path.read_text(encoding="utf-8")
            yield GeneratorResult(
                root / path.name,
                path.stem,
                f"# {MARK}\n# Its source is tools/bindings/runtime/{path.name}.\n{source}",
            )
        yield GeneratorResult(root / "py.typed", "marker", "# This package has annotations.\n")

    def render_area(
        self,
        resolver: DependenciesResolver,
        classes: list[Class],
        model: Model,
        lazy: dict[str, str],
    ) -> str:
        """One module of dataclasses; fills `lazy` with what its annotations need elsewhere."""
        own = {obj.qname for obj in classes}
        now = {ext.type.qname for obj in classes for ext in obj.extensions}
        now |= {
            attr.default[6:].split("::")[0]
            for obj in classes
            for attr in obj.attrs
            if isinstance(attr.default, str) and attr.default.startswith("@enum@")
        }
        for obj in classes:
            for attr in obj.attrs:
                for choice in attr.choices:
                    for kind in choice.types:
                        if not kind.native and kind.qname not in own | now:
                            kind.circular = True
        resolver.process(classes)
        imports = self.imports_of(classes, own)
        if any(imp.alias for imp in imports):
            raise ValueError(f"{classes[0].module}: two classes of one name meet")
        ordered = resolver.sorted_classes()
        output = self.render_classes(ordered, classes[0].target_namespace)
        eager, later = [], []
        for imp in imports:
            record = model.records[imp.qname]
            line = f"from {PACKAGE}.{record.module} import {record.name}"
            if imp.qname in now:
                eager.append(line)
            else:
                later.append("    " + line)
                lazy[record.name] = record.module
        head = [f'"""COLLADA 1.5, dataclasses of {classes[0].module}. {MARK}"""']
        defaults = self.filters.default_imports(output).split("\n")
        typing = "from typing import TYPE_CHECKING"
        linking = f"from {PACKAGE}.linking import Stated" if "Stated)" in output else ""
        forms = [name for name in ("Every", "One") if f" = {name}[" in output]
        choices = f"from {PACKAGE}.choices import {', '.join(forms)}" if forms else ""
        guard = ["if TYPE_CHECKING:", *sorted(later)] if later else []
        namespace = f'__NAMESPACE__ = "{classes[0].target_namespace}"'
        return "\n".join(
            [
                *head,
                "",
                *defaults,
                typing,
                choices,
                linking,
                *sorted(eager),
                *guard,
                "",
                namespace,
                output,
            ]
        )

    def imports_of(self, classes: list[Class], own: set[str]) -> list[Import]:
        """Every class of another module that these refer to."""
        names: set[str] = set()
        for obj in classes:
            names |= {ext.type.qname for ext in obj.extensions}
            for attr in obj.attrs:
                for field in (attr, *attr.choices):
                    if not field.is_prohibited:
                        names |= {kind.qname for kind in field.types if not kind.native}
        return [Import(qname=name, source="") for name in sorted(names - own)]

    def render_classes(self, classes: list[Class], module_namespace: str | None) -> str:
        """The source of the classes, each with a docstring; some remember stated defaults.

        Without a docstring, `dataclass` would make one of the signature, at a high price.
        """
        output = f"\n{super().render_classes(classes, module_namespace)}"
        for obj in classes:
            name = self.filters.class_name(obj.name)
            base = "Stated" if obj.qname in self.stated else ""
            start = re.compile(rf"^class {name}(\((.*)\))?:$", re.MULTILINE)
            found = start.search(output)
            if found is None:
                raise ValueError(f"class {name} was not rendered")
            bases = ", ".join(part for part in (found[2], base) if part)
            head = f"class {name}{f'({bases})' if bases else ''}:"
            doc = f'    """{described(self.records[obj.qname], obj)}"""'
            names = "".join(f"    {line}\n" for line in self.choices_of(obj))
            body = output[found.end() :]
            output = f"{output[: found.start()]}{head}\n{doc}\n{names and chr(10)}{names}{body}"
        return output

    def choices_of(self, obj: Class) -> Iterator[str]:
        """Names for the classes that may stand in each choice of a class."""
        record = self.records[obj.qname]
        taken = {entry.name for entry in record.fields}
        own = {self.filters.field_name(attr.name, obj.name) for attr in obj.attrs}
        for entry in record.fields:
            if entry.name not in own or len(entry.branches) < 2:
                continue
            kinds = [branch.content for branch in entry.branches]
            for branch in entry.branches:
                kind = branch.content
                name = self.filters.field_name(branch.qname.rpartition("}")[2], obj.name)
                # A name that means something else in the class would change its annotations.
                if not isinstance(kind, Record) or name in ANNOTATED:
                    continue
                if kinds.count(kind) > 1 or name in taken:
                    raise ValueError(f"{record.name}.{name}: a choice that cannot be named")
                taken.add(name)
                form = "Every" if entry.many else "One"
                yield f'{name} = {form}["{kind.name}"]("{entry.name}", "{kind.name}")'


def described(record: Record, obj: Class) -> str:
    """One line on what a class stands for."""
    if record.is_enumeration:
        return f"The values of {obj.name}."
    if record.is_element:
        return f"The element {obj.meta_name or obj.name}."
    if record.is_type:
        return f"The type {obj.meta_name or obj.name}."
    return f"A type without a name in the schema: {obj.name}."


def remembers(root: Record, model: Model) -> bool:
    """Whether a class or one derived from it has to remember stated defaults."""
    return any(record.has_stated and root in ancestry(record) for record in model.records.values())


def homes(records: list[Record]) -> dict[str, str]:
    """The module of each class by name; the profile's yield to COLLADA's."""
    result: dict[str, str] = {}
    for record in sorted(records, key=lambda r: (r.module == PROFILE, r.module)):
        home = result.setdefault(record.name, record.module)
        if home != record.module and record.module != PROFILE:
            raise ValueError(f"{record.name} is in {home} and in {record.module}")
    return result
