"""Random use by three clients, the workbook changing under them: never stuck, nothing lost, each state as edited."""

from __future__ import annotations

import pytest
from random_use import Use


@pytest.mark.parametrize("seed", [2, 3, 5])
def test_random_use_loses_nothing_and_shows_what_the_edited_workbook_gives(running, tmp_path, seed):
    use = Use(running, tmp_path, tmp_path / "state", seed)
    for _ in range(12):
        for _ in range(use.dice.randint(1, 8)):
            use.step()
        use.check()
    assert use.compared >= 6
    use.close()


def test_a_handle_whose_window_goes_is_let_go(running, tmp_path):
    use = Use(running, tmp_path, tmp_path / "state", 1)
    first, second, _ = use.clients
    row = first.heard_last("state")["assumptions"][0]
    number = next(each for each in row["numbers"] if each["value"] is not None)
    use._set(first, "assumption", row["name"], number["key"], number["value"] + 0.25, held=True)
    second.next("moved")
    first.stack.close()
    state = second.next("state", lambda message: message["changes"] != [])
    assert state["undo"] is True
    use.clients[0] = use._client()
    use.check()
    use.close()
