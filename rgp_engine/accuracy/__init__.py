"""What accuracy costs in time: which settings are measured, how their error is told, which are worth their time.

Nothing here renders or knows Blender; `rgp_engine.sweep` does.
"""
