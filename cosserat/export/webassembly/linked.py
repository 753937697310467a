"""A module of WebAssembly from one relocatable object, without a linker.

An object of LLVM is almost a module: it has numbers of functions and addresses in it that are right if it stands alone.
It wants a memory, a stack and a table from outside and exports nothing.  Here it gets its own: the memory, first the
data of the object, then the stack, then the pile of `cosserat.export.webassembly.compiled`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

CUSTOM, TYPE, IMPORT, FUNCTION, TABLE, MEMORY, GLOBAL, EXPORT, START, ELEMENT, CODE, DATA, COUNT = range(
    13
)
"""Sections of a module; a custom one has a name."""
_ORDER = (TYPE, FUNCTION, TABLE, MEMORY, GLOBAL, EXPORT, ELEMENT, COUNT, CODE, DATA)
_I32, _CONST, _END, _MUTABLE, _FUNCREF = b"\x7f", b"\x41", b"\x0b", b"\x01", b"\x70"
_SYMBOLS, _OF_FUNCTION, _OF_DATA, _OF_SECTION = 8, 0, 1, 3
_STACK = 1 << 17  # bytes
_PAGE = 1 << 16


@dataclass
class Reader:
    """Bytes and a place in them."""

    data: bytes
    at: int = 0

    def number(self) -> int:
        """A number of seven bits a byte, the last byte below 128."""
        value = shift = 0
        while True:
            byte = self.data[self.at]
            self.at += 1
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value

    def take(self, count: int) -> bytes:
        """The next bytes."""
        self.at += count
        return self.data[self.at - count : self.at]

    def name(self) -> str:
        """A text with its length before it."""
        return self.take(self.number()).decode()


@dataclass(frozen=True)
class Symbol:
    """A symbol of an object: the number of a function, or segment and offset of data."""

    name: str
    number: int
    offset: int = 0


def written(value: int) -> bytes:
    """A number that is not negative, seven bits a byte."""
    found = b""
    while value > 127:
        found += bytes([value & 127 | 128])
        value >>= 7
    return found + bytes([value])


def _signed(value: int) -> bytes:
    """The same for a constant in code, whose last byte has a bit for the sign."""
    found = b""
    while value > 63:
        found += bytes([value & 127 | 128])
        value >>= 7
    return found + bytes([value])


def _vector(items: list[bytes]) -> bytes:
    return written(len(items)) + b"".join(items)


def _named(name: str) -> bytes:
    return written(len(name)) + name.encode()


def module(code: bytes, exports: set[str], pile: str = "pile") -> bytes:
    """A module that imports nothing, from an object; it exports these functions and its memory.

    pile : symbol of the word that holds the first free address.

    Raises
    ------
    ValueError : the object needs a function, or a variable other than the stack, from outside.
    """
    sections, custom = _sections(code)
    _check_imports(sections.pop(IMPORT))
    symbols = {symbol.name: symbol for symbol in _symbols(custom["linking"])}
    size = _size_of_data(sections[DATA])
    stack = -(-size // 64) * 64 + _STACK
    sections[MEMORY] = _vector([b"\0" + written(-(-stack // _PAGE) + 1)])
    sections[GLOBAL] = _vector([_I32 + _MUTABLE + _CONST + _signed(stack) + _END])
    if ELEMENT in sections:
        last = 1 + _functions_in(sections[ELEMENT])
        sections[TABLE] = _vector([_FUNCREF + b"\1" + written(last) + written(last)])
    sections[EXPORT] = _vector(
        [_named("memory") + b"\2\0"]
        + [_named(name) + b"\0" + written(symbols[name].number) for name in sorted(exports)]
    )
    free = symbols[pile]
    address = list(_segments(sections[DATA]))[free.number][0] + free.offset
    first = _CONST + _signed(address) + _END
    sections[DATA] = _with_segment(sections[DATA], b"\0" + first + _data(stack))
    if COUNT in sections:
        sections[COUNT] = written(Reader(sections[DATA]).number())
    parts = [
        bytes([kind]) + written(len(sections[kind])) + sections[kind]
        for kind in _ORDER
        if kind in sections
    ]
    return code[:8] + b"".join(parts)


def _sections(code: bytes) -> tuple[dict[int, bytes], dict[str, bytes]]:
    """The sections of an object by number, and the custom ones by name."""
    reader, plain, custom = Reader(code, 8), dict[int, bytes](), dict[str, bytes]()
    while reader.at < len(code):
        kind = reader.take(1)[0]
        body = Reader(reader.take(reader.number()))
        if kind == CUSTOM:
            name = body.name()
            custom[name] = body.data[body.at :]
        else:
            plain[kind] = body.data
    return plain, custom


def _check_imports(section: bytes) -> None:
    reader = Reader(section)
    for _ in range(reader.number()):
        _, name, kind = reader.name(), reader.name(), reader.take(1)[0]
        if kind == 0 or (kind == 3 and name != "__stack_pointer"):
            raise ValueError(f"the object needs {name}, which it does not have; compile it as well")
        if kind == 3:
            reader.take(2)
            continue
        if kind == 1:
            reader.take(1)
        limited = reader.take(1)[0]
        for _ in range(1 + (limited & 1)):
            reader.number()


def _symbols(section: bytes) -> Iterator[Symbol]:
    """The symbols of functions and of data that the object has."""
    reader = Reader(section)
    reader.number()  # the version
    while reader.at < len(section):
        kind = reader.take(1)[0]
        part = Reader(reader.take(reader.number()))
        if kind == _SYMBOLS:
            yield from _symbol_table(part)


def _symbol_table(reader: Reader) -> Iterator[Symbol]:
    for _ in range(reader.number()):
        kind, flags = reader.take(1)[0], reader.number()
        missing, named = bool(flags & 0x10), bool(flags & 0x40)
        if kind == _OF_DATA:
            name = reader.name()
            if not missing:
                segment, offset, _ = reader.number(), reader.number(), reader.number()
                yield Symbol(name, segment, offset)
            continue
        number = reader.number()
        if kind != _OF_SECTION and (named or not missing):
            name = reader.name()
            if kind == _OF_FUNCTION:
                yield Symbol(name, number)


def _size_of_data(section: bytes) -> int:
    return max((at + len(data) for at, data in _segments(section)), default=0)


def _segments(section: bytes) -> Iterator[tuple[int, bytes]]:
    """Address and bytes of each segment of data."""
    reader = Reader(section)
    for _ in range(reader.number()):
        assert (reader.number(), reader.take(1)) == (0, _CONST)
        at = reader.number()
        assert reader.take(1) == _END
        yield at, reader.take(reader.number())


def _functions_in(section: bytes) -> int:
    reader = Reader(section)
    assert (reader.number(), reader.number(), reader.take(1)) == (1, 0, _CONST)
    reader.number()
    reader.take(1)
    return reader.number()


def _data(word: int) -> bytes:
    return written(4) + word.to_bytes(4, "little")


def _with_segment(section: bytes, segment: bytes) -> bytes:
    reader = Reader(section)
    count = reader.number()
    return written(count + 1) + section[reader.at :] + segment
