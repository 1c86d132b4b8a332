"""What the compiled module offers, by introspection: a function that is new in the bindings is found by itself."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from types import ModuleType
from typing import Any, Literal

Kind = Literal["call", "make", "read", "write"]
_SHORTER = (
    ("typing.SupportsFloat | typing.SupportsIndex", "float"),
    ("typing.SupportsInt | typing.SupportsIndex", "int"),
)


@dataclass(frozen=True)
class Argument:
    """One argument, as pybind11 writes it into the docstring."""

    name: str
    type: ast.expr
    has_default: bool

    @property
    def positional(self) -> bool:
        """pybind11 calls it arg0, arg1 where the binding gives it no name: then no keyword reaches it."""
        return re.fullmatch(r"arg\d+", self.name) is not None


@dataclass(frozen=True)
class Function:
    """A function, a method, a constructor, or all attributes of a class that can be read, or written."""

    owner: str | None  #: class
    name: str
    kind: Kind
    arguments: tuple[Argument, ...] = ()
    returns: frozenset[str] = frozenset()  #: classes of the module in what it gives
    doc: str = ""
    attributes: tuple[str, ...] = ()  #: of "read" and "write"
    answers: bool = True  #: False: all it does is to raise

    @property
    def label(self) -> str:
        """As the table at the end says it."""
        if self.kind == "make":
            return f"{self.owner}()"
        return f"{self.owner}.{self.name}" if self.owner else self.name


def functions_of(core: ModuleType) -> list[Function]:
    """Everything that can be called in the module, in its order."""
    found: list[Function] = []
    for name, thing in vars(core).items():
        if isinstance(thing, type):
            if not issubclass(thing, BaseException):
                found += _of_class(thing)
        elif callable(thing):
            found += _signatures(None, name, thing)
    return found


def _of_class(cls: type) -> list[Function]:
    found: list[Function] = []
    getters, setters, given = [], [], set()
    for name, member in vars(cls).items():
        if isinstance(member, property):
            getters.append(name)
            setters += [name] if member.fset is not None else []
            given |= _classes(getattr(member.fget, "__doc__", None) or "")
        elif type(member).__name__ == "instancemethod":
            found += _signatures(cls.__name__, name, member)
    given.discard(cls.__name__)
    owner, read, written = cls.__name__, tuple(getters), tuple(setters)
    if read:
        found.append(Function(owner, "(read)", "read", returns=frozenset(given), attributes=read))
    if written:
        found.append(Function(owner, "(write)", "write", attributes=written))
    return found


def _signatures(owner: str | None, name: str, thing: Any) -> list[Function]:
    """One for each overload."""
    doc = thing.__doc__ or ""
    found = []
    for line in doc.splitlines():
        text = re.sub(r"^\d+\. ", "", line)
        if not text.startswith(f"{name}(") or text.startswith(f"{name}(*args, **kwargs)"):
            continue
        for long, short in _SHORTER:
            text = text.replace(long, short)
        tree = ast.parse(f"def {text}: ...").body[0]
        assert isinstance(tree, ast.FunctionDef)
        plain = tree.args.args
        without = len(plain) - len(tree.args.defaults)
        given = [(a, k >= without) for k, a in enumerate(plain)]
        keywords = zip(tree.args.kwonlyargs, tree.args.kw_defaults, strict=True)
        given += [(a, default is not None) for a, default in keywords]
        arguments = tuple(
            Argument(a.arg, a.annotation, has_default)
            for a, has_default in given
            if a.annotation is not None and a.arg != "self"
        )
        if tree.args.kwarg is not None:
            arguments += (Argument("kwargs", ast.Name("kwargs"), True),)
        makes = name == "__init__"
        answer = ast.unparse(tree.returns) if tree.returns is not None else ""
        found.append(
            Function(
                owner,
                name,
                "make" if makes else "call",
                arguments,
                frozenset([owner]) if makes and owner else frozenset(_classes(answer)),
                doc[len(line) :].strip(),
                answers=answer != "typing.Never",
            )
        )
    return found


def _classes(text: str) -> set[str]:
    return set(re.findall(r"sms\._core\.(\w+)", text.rsplit("->", 1)[-1]))
