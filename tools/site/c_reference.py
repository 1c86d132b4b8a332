"""Reference of the C ABI: a page for each header for C, made from the headers themselves."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tools.site.headers import Header, read
from tools.site.prose import escaped, indented, restructured, title

HEADERS = (
    "sms.h",
    "kinematics.h",
    "dynamics.h",
    "pneumatics.h",
    "plant.h",
    "controller.h",
    "table.h",
    "frame.h",
    "version.h",
)
FUNCTION = re.compile(r"^(?:static inline )?((?:const )?\w[\w ]*?[ *]+)(sms_\w+)\(", re.MULTILINE)
ENUM = re.compile(r"typedef enum \w+ \{(.*?)\} (\w+);", re.DOTALL)
STRUCT = re.compile(r"typedef struct (?:SMS_NAME\()?(\w+)\)? \{(.*?)\n\} ", re.DOTALL)
FIELD = re.compile(r"^ *(.+?) *(\w+)((?:\[\w+\])*);")
MACRO = re.compile(r"^#define (SMS_[A-Z_]+) (\"?[\w.]+\"?)$", re.MULTILINE)
STRUCTS = re.compile(r'#define SMS_STRUCTS "sms/(\w+\.def)"')


def pages() -> Iterator[tuple[str, str]]:
    """(name, text) of every page."""
    for name in HEADERS:
        header = read(name)
        out = [*title(f"``{name}``"), *restructured(header.head), ""]
        out += [*_macros(header), *_enums(header), *_structs(header), *_functions(header)]
        yield f"c/{name.removesuffix('.h')}", "\n".join(out) + "\n"


def public_names() -> set[str]:
    """Every function, struct, enum and constant of the headers for C."""
    names: set[str] = set()
    for name in HEADERS:
        text = "\n".join(read(name).lines)
        names |= {m[2] for m in FUNCTION.finditer(text)}
        names |= {m[2] for m in ENUM.finditer(text)} | {m[1] for m in MACRO.finditer(text)}
        for structs in STRUCTS.findall(text):
            for struct in STRUCT.finditer("\n".join(read(structs).lines)):
                names |= {struct[1], f"{struct[1]}f"}
        names |= {m[1] for m in STRUCT.finditer(text)}
    return names


def _line(text: str, position: int) -> int:
    return text.count("\n", 0, position) + 1


def _macros(header: Header) -> Iterator[str]:
    text = "\n".join(header.lines)
    for macro in MACRO.finditer(text):
        if macro[1] == "SMS_STRUCTS":
            continue
        yield from (f".. c:macro:: {macro[1]}", "", f"   ``{macro[2]}``", "")
        yield from indented(restructured(header.comment_above(_line(text, macro.start()))))
        yield ""


def _enums(header: Header) -> Iterator[str]:
    text = "\n".join(header.lines)
    for enum in ENUM.finditer(text):
        yield from (f".. c:enum:: {enum[2]}", "")
        yield from indented(restructured(header.comment_above(_line(text, enum.start()))))
        first = _line(text, enum.start(1))
        for number, line in enumerate(enum[1].split("\n"), first):
            for one in re.finditer(
                r"\b([A-Z][A-Z0-9_]+)\b(?: = -?\w+)?(?=,|\s*(?:/\*|$))", line.split("/*")[0]
            ):
                yield from ("", f"   .. c:enumerator:: {one[1]}", "")
                yield f"      {escaped(header.comment_behind(number))}"
        yield ""


def _structs(header: Header) -> Iterator[str]:
    text = "\n".join(header.lines)
    yield from _structs_of(header, text, ("",))
    for name in STRUCTS.findall(text):
        of_both = read(name)
        yield from _structs_of(of_both, "\n".join(of_both.lines), ("", "f"))


def _structs_of(header: Header, text: str, endings: tuple[str, ...]) -> Iterator[str]:
    for struct in STRUCT.finditer(text):
        comment = header.comment_above(_line(text, struct.start()))
        for ending in endings:
            yield from (f".. c:struct:: {struct[1]}{ending}", "")
            if ending:
                yield from (f"   :c:struct:`{struct[1]}` in float.", "")
                continue
            yield from indented(restructured(comment))
            first = _line(text, struct.start(2))
            for number, line in enumerate(struct[2].split("\n"), first):
                if line.startswith("#define"):
                    continue
                if field := FIELD.match(line):
                    kind = field[1].replace("SMS_SCALAR", "double")
                    kind = re.sub(r"SMS_NAME\((\w+)\)", r"\1", kind)
                    yield from ("", f"   .. c:member:: {kind} {field[2]}{field[3]}", "")
                    yield f"      {escaped(header.comment_behind(number))}"
                elif "#include" in line:
                    yield from (
                        "",
                        f"   Its members are those of ``{line.split(chr(34))[1]}``.",
                        "",
                    )
        yield ""


def _functions(header: Header) -> Iterator[str]:
    text = "\n".join(header.lines)
    comment: list[str] = []
    for function in FUNCTION.finditer(text):
        number = _line(text, function.start())
        own = header.comment_above(number)
        comment = own or comment  # the twin in float stands under the same comment
        head = re.match(r"[^;{]*?\)(?=\s*[;{])", text[function.start() :])
        if head is None:
            continue
        signature = re.sub(r"\s+", " ", head[0]).removeprefix("static inline ")
        yield from (f".. c:function:: {signature}", "")
        if function[2].endswith("f") and function[2][:-1] + "(" in text:
            yield f"   :c:func:`{function[2][:-1]}` in float."
        else:
            yield from indented(restructured(comment))
        yield ""
