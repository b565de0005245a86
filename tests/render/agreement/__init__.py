"""Every feature alone, rendered by RGP Engine and by Cycles in one process, and how well both agree: `make agreement`.

`features.py` lists what is compared, `measure.py` renders and compares, `page.py` and `sheet.py` write
`docs/agreement.md` with its pictures.
"""
