from studio.engine.paper import PAPER_JOINTS, paper_table
from studio.engine.sweep import PAPER_NEURONS


def test_the_table_is_the_papers():
    rows = paper_table()
    assert tuple(row.neurons for row in rows) == PAPER_NEURONS
    assert all(tuple(row.mse) == PAPER_JOINTS for row in rows)
    assert rows[0].mse == {"s0": 0.0122, "s1": 0.0391, "e1": 0.0073}
