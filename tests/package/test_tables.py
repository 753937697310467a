"""Tables of numbers in a case: rows, and CSV files with units in their headers."""

from typing import Annotated

import numpy as np
import pytest

from cosserat.errors import InputError
from cosserat.parameters import Parameters
from cosserat.tables import Columns, Rows


class Recorded(Parameters):
    record: Annotated[Rows, Columns((("time", "s"), ("force", "N")))]
    """A record."""


def read(tmp_path, text, **changes):
    (tmp_path / "a.csv").write_text(text, **changes)
    return Recorded.read({"record": "a.csv"}, "it", folder=tmp_path).record


ROWS = ((0.0, 1000.0), (0.5, -2500.0))


@pytest.mark.parametrize(
    "text",
    [
        "time [s],force [N]\n0,1000\n0.5,-2500\n",
        "Time (ms);note;Force (kN)\n0;a;1\n500;b;-2.5\n",
        "# a logger\nforce [N]\ttime [s]\n\n1e3\t0\n-2500\t.5\n",
        "\ufefftime [s],force [N]\r\n0,1000\r\n0.5,-2500\r\n",
    ],
)
def test_a_file_is_read_by_the_names_and_units_of_its_header(tmp_path, text):
    np.testing.assert_allclose(read(tmp_path, text), ROWS, rtol=1e-15)


def test_rows_are_read_in_a_case_and_in_python():
    from_file = Recorded.read({"record": [["0 s", "1 kN"], ["500 ms", "-2.5 kN"]]}, "it").record
    np.testing.assert_allclose(from_file, ROWS, rtol=1e-15)
    assert Recorded(record=np.array(ROWS)).record == ROWS
    again = Recorded.model_validate_json(Recorded(record=ROWS).model_dump_json())
    assert again.record == ROWS


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "is the file 'a.csv', which is empty"),
        ("0,1\n2,3\n", "whose header has no column 'time'"),
        ("time,force [N]\n0,1\n1,2\n", "whose column 'time' has no unit; write 'time [s]'"),
        (
            "time [s],force [m]\n0,1\n1,2\n",
            "whose column 'force' is \"1 m\", in m, a length and not a force",
        ),
        ("time [s],force [N]\n0,1\n1\n", "whose row 2 has 1 cells, but the header has 2"),
        ("time [s],force [N]\n0,1\n1,x\n", "whose row 2 is '1,x', with a cell that is no number"),
        ("time [s],force [N]\n0,1\n1,nan\n", "with a cell that is not finite"),
        ("time [s],force [N]\n0,1\n", "has 1 row; it needs 2 or more"),
        ("time [s],force [N]\n0,1\n2,1\n2,3\n", "has time 2 before 2; sort the rows by time"),
    ],
)
def test_a_fault_of_a_file_is_one_sentence(tmp_path, text, sentence):
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        ("missing.csv", "is the file 'missing.csv', which cannot be read (No such file or directory)"),
        (5, "is 5; it must be a list of rows [time in s, force in N], or the name of a CSV file"),
        ([["0 s", "1 N"], ["1 s"]], "has the row ['1 s'] at 1; each row must be [time, force]"),
        ([["0 s", "1 N"], [1, "1 N"]], "has a fault: row 1, time, is 1, without a unit"),
    ],
)
def test_a_fault_of_rows_is_one_sentence(value, sentence):
    with pytest.raises(InputError) as caught:
        Recorded.read({"record": value}, "it")
    assert sentence in str(caught.value)


def test_a_file_in_another_encoding_is_refused(tmp_path):
    with pytest.raises(InputError, match="not in UTF-8; save it as UTF-8"):
        read(tmp_path, "time [s],force [N]\n0,1\n1,2\n", encoding="utf-16")
