"""Whether what was learned does its task, many times over, under conditions that differ.

`variation` says what differs, `motion` what is done, `trial` does it once; `runs` does it many
times, side by side, and keeps what is over in a `journal`; `evaluation` makes rates of it
(`interval`), and `grid` asks the same of many networks. `report`, `charts` and `page` show it.
"""
