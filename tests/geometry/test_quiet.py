"""Printing of the engines stays off the terminal."""

import ctypes
import os

from pneumorph.geometry.quiet import caught_output


def test_output_below_python_is_caught_and_python_output_around_it_is_not(capfd):
    print("before")
    with caught_output() as printed:
        os.write(1, b"engine\n")
        ctypes.CDLL(None).puts(b"buffered")
    print("after")
    assert sorted(printed.text.split()) == ["buffered", "engine"]
    assert capfd.readouterr().out.split() == ["before", "after"]
