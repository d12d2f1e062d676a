"""What results show of themselves in a notebook: numbers with units, a picture, no raw markup."""

import subprocess
import sys
from typing import Any

import numpy as np
import pytest

import ebac
from ebac._util import formatting, notebook, report
from ebac.studies.measures import MEASURES

SHORT = ebac.Scenario(seconds=0.3)


def results() -> list[Any]:
    """One of each kind, as small as can be."""
    hands = ebac.Operators.grid()
    few = ebac.Operators.from_columns({k: v[:4] for k, v in hands.columns().items()})
    law = ["ebac"]
    return [
        ebac.simulate(SHORT, "ebac"),
        ebac.contact(ebac.simulate(SHORT, "ebac")),
        ebac.study(few, law),
        ebac.sweep([SHORT], law),
        ebac.zwidth(law, base=SHORT, delays=[1], dampings=[0.0, 10.0], rungs=5),
        ebac.stiffest(law, population=few, stiffnesses=[1e3, 2e3], base=SHORT),
        ebac.stability_map(base=SHORT, xs=[2.0, 4.0], ys=[1e3, 10e3]),
        ebac.ablation(few, changes=[{"guard": False}], beside=(), measures=MEASURES[:2]),
    ]


@pytest.mark.slow
def test_every_result_shows_a_table_and_a_picture() -> None:
    for result in results():
        shows(result)


def shows(result: Any) -> None:
    html = result._repr_html_()
    assert html.count("<table>") == html.count("</table>") == 1
    assert html.count("<tr>") >= 2
    assert "<ebac" not in html
    assert "<td>nan</td>" not in html or isinstance(
        result, ebac.Trace
    )  # of a column without a number
    if not isinstance(result, ebac.Contact):
        assert html.count('<img alt="figure"') == 1
        assert "data:image/png;base64,iVBOR" in html


def test_headings_have_the_unit_people_read_and_cells_the_number_in_it() -> None:
    html = notebook.table([{"rest_m": 0.0012, "least_energy_J": None, "mass_kg": 0.25, "good": 60}])
    assert "<th>rest [mm]</th><th>least energy [mJ]</th><th>mass [kg]</th><th>good</th>" in html
    assert "<td>1.200</td><td>-</td><td>0.25</td><td>60</td>" in html


def test_every_unit_of_a_key_is_one_that_keys_have() -> None:
    for ending, unit in report.UNITS.items():
        assert f"[{formatting.shown(unit)}]" in notebook.table([{f"a{ending}": 1.0}])


def test_a_long_table_is_cut_in_the_middle_and_says_so() -> None:
    html = notebook.table([{"run": i} for i in range(1000)], most=10)
    assert html.count("<tr>") == 1 + 10 + 1
    assert "... 990 more ..." in html
    assert "<td>0</td>" in html
    assert "<td>999</td>" in html


def test_names_cannot_bring_markup_into_the_page() -> None:
    html = notebook.table([{"<b>": "<script>alert(1)</script>"}])
    assert "<script>" not in html
    assert "<b>" not in html


def test_an_empty_result_says_so() -> None:
    assert notebook.table([]) == "<p>no rows</p>"


def test_a_sweep_without_a_point_of_rest_shows_its_table_alone() -> None:
    result = ebac.sweep([SHORT.replace(environment=ebac.Free())], ["direct"])
    assert "<img" not in result._repr_html_()
    assert np.isnan(result["ideal_m"]).all()


def test_a_sweep_has_one_table_below_its_title() -> None:
    html = ebac.sweep([SHORT], ["direct"])._repr_html_()
    assert html.startswith("<p>SweepResult: 1 run under direct, 1 done</p>")


def test_a_contact_begins_as_its_text_does() -> None:
    contact = ebac.contact(ebac.simulate(ebac.Scenario(seconds=1.0), "tca-damped"))
    title, force, *lines = str(contact).splitlines()
    html = contact._repr_html_()
    assert html.startswith(f"<p>{title}; {force.strip()}</p>")
    for line in lines:
        assert f"<td>{line[2:22].strip()}</td><td>{line[22:]}</td>" in html


def test_a_zwidth_has_the_numbers_of_its_text_whatever_the_laws() -> None:
    found = ebac.zwidth(["ebac"], base=SHORT, delays=[1], dampings=[0.0, 10.0], rungs=3)
    title, headings, cells = repr(found).splitlines()[:3]
    html = found._repr_html_()
    assert html.startswith(f"<p>{title}")
    assert all(f"<th>{one.strip()}</th>" in html for one in headings.split("  ") if one)
    assert all(f"<td>{cell.strip()}</td>" in html for cell in cells.split("  ") if cell)


def test_nothing_is_drawn_before_a_result_is_shown() -> None:
    code = (
        "import sys, ebac; r = ebac.sweep([ebac.Scenario(seconds=0.1)], ['tca']); repr(r); "
        "print([m for m in ('matplotlib', 'bokeh', 'ebac._util.notebook', 'ebac.explore') if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.strip() == "[]"
