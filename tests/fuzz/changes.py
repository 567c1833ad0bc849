"""Changes to the bytes and lines of a valid file."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import strategies as st

# what breaks readers: separators, quotes, numbers out of range, words of the formats
PIECES = [
    b"", b"\n", b"\n\n", b"\r", b"\0", b" ", b"\t", b",", b";", b"=", b"#", b"*", b"$", b'"', b"'", b"[", b"]", b"{",
    b"-1", b"0", b"1e999", b"nan", b"inf", b"99999999999999999999999", b"1.5", b"-0", b"0x7f", b"1,5", b"\xff\xfe",
    b"\xef\xbb\xbf", "\u2028µ²".encode(), b"name", b"end", b"<", b"/>",
]  # fmt: skip


@st.composite
def changed_bytes(draw: st.DrawFn, files: Sequence[bytes], most: int = 6) -> bytes:
    """Return one of the files with some bytes, tokens or lines replaced, removed, doubled or exchanged, or cut off."""
    data = draw(st.sampled_from(list(files)))
    for _ in range(draw(st.integers(1, most))):
        if not data:
            break
        change = draw(
            st.sampled_from(["byte", "piece", "piece", "token", "token", "line", "double", "exchange", "cut"])
        )
        at = draw(st.integers(0, len(data) - 1))
        if change == "byte":
            data = data[:at] + bytes([draw(st.integers(0, 255))]) + data[at + 1 :]
        elif change == "piece":
            data = data[:at] + draw(st.sampled_from(PIECES)) + data[at + draw(st.integers(0, 4)) :]
        elif change == "cut":
            data = data[:at] if draw(st.booleans()) else data[at:]
        elif change == "token":
            start, end = _token(data, at)
            data = data[:start] + draw(st.one_of(st.sampled_from(PIECES), st.binary(max_size=6))) + data[end:]
        else:
            lines = data.splitlines(keepends=True)
            one, other = (draw(st.integers(0, len(lines) - 1)) for _ in range(2))
            if change == "line":
                del lines[one]
            elif change == "double":
                lines.insert(other, lines[one])
            else:
                lines[one], lines[other] = lines[other], lines[one]
            data = b"".join(lines)
    return data


def _token(data: bytes, at: int) -> tuple[int, int]:
    """Return the ends of the run without separators around a place."""
    gaps = b" \t\r\n,;=<>\"'()"
    start = end = at
    while start > 0 and data[start - 1] not in gaps:
        start -= 1
    while end < len(data) and data[end] not in gaps:
        end += 1
    return start, end
