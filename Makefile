# Thin on purpose: the work is in tools/, standard-library Python that sets up whatever a command needs.
SCENE ?= scenes/cornell_box.blend
BPY ?=
PYTHON ?=
ARGS ?=
QUICK ?=

# The first Python that really runs; it only starts the tools, which then look for the one each Blender needs.
HOST := $(shell for p in python3 python3.13 python3.11; do $$p -c '' 2>/dev/null && echo $$p && break; done)
TOOLS = $(if $(HOST),$(HOST),$(error Python 3.11 or 3.13 is needed, and none runs here)) -m tools

.DEFAULT_GOAL := help
.PHONY: help render test hard fuzz lint bench tables agreement scenes extension lock clean

help: ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "make %-10s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

render: ## render SCENE to out/ as EXR, PNG and JSON: make render [SCENE=scenes/cornell_box.blend] [BPY=5.0.1] [ARGS=...]
	@$(TOOLS) render --scene "$(SCENE)" --bpy "$(BPY)" $(ARGS)

test: ## every test, on every Blender this machine's Pythons allow: make test [BPY=5.0.1] [ARGS="-k name"]
	@$(TOOLS) test --bpy "$(BPY)" $(ARGS)

hard: ## the hard cases, heavy ones too, into docs/stability.md and docs/stability.json
	@$(TOOLS) hard --bpy "$(BPY)" $(ARGS)

fuzz: ## inputs that nobody meant, through every public door: make fuzz [ARGS="--seconds 60"] (of each target; 0 for none)
	@$(TOOLS) fuzz --bpy "$(BPY)" $(ARGS)

lint: ## format, clippy, ruff, types, stub against binary, layers
	@$(TOOLS) lint

bench: ## speed, printed and written to out/bench.json
	@$(TOOLS) bench --bpy "$(BPY)" $(ARGS)

tables: ## the paper's tables with our figures, into docs/results: make tables [QUICK=1] (rough, into out/tables)
	@$(TOOLS) tables --bpy "$(BPY)" $(if $(QUICK),--quick) $(ARGS)

agreement: ## every feature against Cycles, into docs/agreement.md: make agreement [ARGS="lamp/ path/"] (prints only those)
	@$(TOOLS) agreement --bpy "$(BPY)" $(ARGS)

scenes: ## files that others made against Cycles, into docs/real-scenes.md (they lie in ../shared/scenes; not part of this)
	@$(TOOLS) scenes --bpy "$(BPY)" $(ARGS)

extension: ## dist/*.zip for Blender: make extension [PYTHON=3.13]
	@$(TOOLS) extension --bpy "$(BPY)" --python "$(PYTHON)"

lock: ## resolve the Python packages anew (needs uv)
	@for file in requirements/*.in; do \
	  case $$file in *bpy-5.2*) python=3.13 ;; *environment.in) continue ;; *) python=3.11 ;; esac; \
	  uv pip compile --quiet --universal --generate-hashes --python-version $$python $$file -o $${file%.in}.txt; \
	done

clean: ## remove everything these commands made
	@$(TOOLS) clean
