"""Tables of notebooks, and names in a line."""

from symbolic.equations.variables import SwitchInfo
from symbolic.system.overview import overview
from symbolic.tables import MOST_LISTED, listed, table


def test_table() -> None:
    """Assert headings, cells and how many rows there are; nothing for a table without rows."""
    found = table(["name", "unit"], [["x<y", "m"], ["v", "m/s"]], title="states")
    assert "<summary>states (2)</summary>" in found
    assert all(cell in found for cell in (">name<", ">unit<", ">x&lt;y<", ">m/s<"))
    assert found.startswith("<details open>")
    assert table(["name"], []) == ""
    assert table(["name"], [["x"]] * (MOST_LISTED + 1)).startswith("<details>")


def test_names_in_a_line() -> None:
    """Assert that many names are cut, with how many there are, and none are listed."""
    assert listed(["a", "b"]) == "a, b"
    assert listed([]) == "none"
    assert listed(str(k) for k in range(MOST_LISTED + 1)).endswith(f", ... ({MOST_LISTED + 1})")


def test_switches_say_how_they_are_passed() -> None:
    """Assert a word for each way."""
    words = {-1: "falling", 0: "both ways", 1: "rising"}
    for way, word in words.items():
        assert f">{word}</td>" in overview("", {}, [SwitchInfo("s", way)])
