"""The examples of docs/python.md run, in their order, and print what they say."""
import re

import pytest

pytest.importorskip("matplotlib")


def test_the_examples_of_the_guide(root, monkeypatch, capsys):
    monkeypatch.chdir(root)
    page = (root / "docs/python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"<!-- python -->\n```python\n(.*?)```", page, re.DOTALL)
    assert len(blocks) >= 7
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    printed = capsys.readouterr().out
    for expected in ("[155.22221564]", "18.7395", "did you mean 'stiffness_Nm_per_rad'"):
        assert expected in printed
    assert abs(names["force"].value - 188.9017673) < 1e-6 and names["force"].error < 1e-6


def test_every_name_of_the_guide_is_there(root):
    import drev

    page = (root / "docs/python.md").read_text(encoding="utf-8")
    for name in set(re.findall(r"drev\.([A-Za-z_]\w*)", page)) - {"md", "toml"}:
        assert hasattr(drev, name), name
    for name in set(re.findall(r"`([a-z_]+)\(", page)) - {"str", "help"}:
        assert any(hasattr(cls, name) for cls in (drev.Model, drev.Run, drev.Sweep, drev)), name


def test_the_readme_names_the_package(root):
    assert "docs/python.md" in (root / "README.md").read_text(encoding="utf-8")
