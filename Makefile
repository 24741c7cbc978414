# Abut. `make` builds, `make run` shows, `make test` proves; what is missing is installed or named by config/setup.sh.
# Another compiler: OMPI_CC=clang make. Another PETSc: make PETSC_DIR=... PETSC_ARCH=... Another build folder: make B=... Whole commands: make V=1.
B        ?= build
PREFIX   ?= /usr/local
CFLAGS   ?= -g -O2
WARNINGS  = -Wall -Wextra -Werror
export PETSC_DIR PETSC_ARCH P4EST_DIR
export OMP_NUM_THREADS ?= 1
ifdef PETSC_DIR
export PATH := $(PETSC_DIR)/$(PETSC_ARCH)/bin:$(PATH)
endif

# What config/setup.sh found: CC, PYTHON, PETSC, DEPS_CFLAGS, DEPS_LIBS, CHECK_CFLAGS, CHECK_LIBS, SLEPC_CFLAGS, SLEPC_LIBS. It rewrites the file
# only when an answer changed, and GNU make then starts again with the new one. Only the goals below may install packages, and only as root on Debian.
TESTING    = test test-long suite
INSTALLING = run test test-long suite fuzz check asan memcheck setup
NO_SETUP   = clean deps deps-dev format lint coverage
ifneq ($(filter-out $(NO_SETUP),$(or $(MAKECMDGOALS),all)),)
include $(B)/config.mk
endif
$(B)/config.mk: FORCE
	@config/setup.sh $@ $(if $(filter $(TESTING),$(MAKECMDGOALS)),test install,$(if $(filter $(INSTALLING),$(MAKECMDGOALS)),all install,build))

# --- what is built ------------------------------------------------------------------------------------------------------------
objects  = $(patsubst %.c,$(B)/obj/%.o,$(wildcard $(1)/*.c))
LIB_OBJ := $(foreach d,$(filter-out src/app,$(patsubst %/,%,$(wildcard src/*/))),$(call objects,$(d)))
APP_OBJ := $(call objects,src/app)
PLUGINS := $(filter-out template,$(sort $(patsubst plugins/%/,%,$(dir $(wildcard plugins/*/*.c)))))
CHECKS  := $(patsubst tests/unit/%.c,$(B)/tests/%,$(wildcard tests/unit/ck_*.c))
LIB     := $(B)/lib/libabut.so
ABUT    := $(if $(APP_OBJ),$(B)/bin/abut)
LINK     = $(say)$(CC) $(CFLAGS) $(LDFLAGS) -Wl,--as-needed
say      = $(if $(V),,@echo '  $(@:$(B)/%=%)'; )
RPATH    = -Wl,-rpath,'$$ORIGIN/../lib'

.DEFAULT_GOAL := all
all: $(LIB) $(PLUGINS:%=$(B)/lib/lib%.so) $(ABUT)

$(LIB): $(LIB_OBJ) | $(B)/lib
	$(LINK) -shared -Wl,-soname,libabut.so $^ -o $@ $(SLEPC_LIBS) $(DEPS_LIBS) -lm -ldl

$(B)/bin/abut: $(APP_OBJ) $(LIB) | $(B)/bin
	$(LINK) $(APP_OBJ) -o $@ -L$(B)/lib -labut $(RPATH) $(DEPS_LIBS) -lm

# A plugin: every source of plugins/NAME in libNAME.so
define plugin_rule
$(B)/lib/lib$(1).so: $(call objects,plugins/$(1)) $(LIB)
	$$(LINK) -shared $(call objects,plugins/$(1)) -o $$@ -L$(B)/lib -labut -Wl,-rpath,'$$$$ORIGIN' $$(DEPS_LIBS) -lm
endef
$(foreach p,$(PLUGINS),$(eval $(call plugin_rule,$(p))))

# A unit test: tests/unit/ck_TOPIC.c; one that begins ck_NAME also sees the inside of the plugin estimator_NAME
inside   = $(foreach p,$(PLUGINS),$(if $(filter ck_$(lastword $(subst _, ,$(p)))%,$(1)),$(call objects,plugins/$(p))))
define check_rule
$(B)/tests/$(1): $(B)/obj/tests/unit/$(1).o $(call inside,$(1)) $(LIB) | $(B)/tests
	$$(LINK) $$(filter %.o,$$^) -o $$@ -L$(B)/lib -labut $$(RPATH) $$(DEPS_LIBS) $$(CHECK_LIBS) -lm
endef
$(foreach t,$(CHECKS),$(eval $(call check_rule,$(notdir $(t)))))

$(B)/obj/tests/%.o: CPPFLAGS += $(PLUGINS:%=-Iplugins/%) $(CHECK_CFLAGS)
$(B)/obj/%.o: %.c $(B)/config.mk
	@mkdir -p $(@D)
	$(say)$(CC) -std=gnu99 $(WARNINGS) $(CFLAGS) -fPIC -MMD -MP -Iinclude $(CPPFLAGS) $(DEPS_CFLAGS) -c $< -o $@
$(B)/obj/src/loop/spectrum.o: CPPFLAGS += $(SLEPC_CFLAGS)
-include $(shell test -d $(B)/obj && find $(B)/obj -name '*.d')
$(B)/bin $(B)/lib $(B)/tests:
	@mkdir -p $@

# --- what is done with it -----------------------------------------------------------------------------------------------------
LAYERS = examples/layers/layers.yml -record out/layers.record -record_csv out/layers.csv \
         -output out/layers.xdmf -output_profile out/layers_profile.csv
run: all
	@mkdir -p out
	$(B)/bin/abut $(LAYERS)
	@$(PYTHON) examples/layers/compare.py out
	@$(PYTHON) examples/layers/plot.py out

# what an answer takes with every loop, some 700 runs: see examples/studies/loops
study-loops: all
	@$(PYTHON) examples/studies/loops/loops.py --abut $(B)/bin/abut --out out

# where the time of an adaptive run goes: see examples/studies/shares
study-shares: all
	@$(PYTHON) examples/studies/shares/shares.py --abut $(B)/bin/abut --out out

# what an answer costs, by order, estimator, marking and following, some 2,000 runs: see examples/studies/accuracy
study-accuracy: all
	@$(PYTHON) examples/studies/accuracy/accuracy.py --abut $(B)/bin/abut --out out

# errors over unknowns, sweeps, CPU seconds and memory: see examples/studies/cost
study-cost: all
	@$(PYTHON) examples/studies/cost/cost.py --abut $(B)/bin/abut --out out
# the points of other programs beside those, from CSV files: see examples/studies/compare
COMPARE = examples/studies/accuracy/peers.csv
study-compare: all
	@$(PYTHON) examples/studies/cost/cost.py --abut $(B)/bin/abut --out out --tables $(COMPARE:%=--compare %)

# estimates against true errors, for the estimators there are and those of PLUGIN="path/to/libestimator_mine.so": see examples/studies/estimators
study-estimators: all
	@$(PYTHON) examples/studies/estimators/estimators.py --abut $(B)/bin/abut --out out $(PLUGIN:%=--plugin %)

# what 1 to 16 ranks send and do, phase by phase, and what that makes of 10^4: see examples/studies/scaling
study-scaling: all
	@$(PYTHON) examples/studies/scaling/scaling.py --abut $(B)/bin/abut --out out

# the paper's Figs 4 to 10, some 35 runs: see docs/paper.md
study-paper: all
	@$(PYTHON) examples/studies/paper/paper.py --abut $(B)/bin/abut --out out/paper

# make test T=layers runs what has "layers" in its name
test: all $(CHECKS)
	@$(PYTHON) tests/run.py --build $(B) $(T)
check: all $(CHECKS)
	@$(PYTHON) tests/run.py --build $(B) --quick $(T)
# the cases V and H of tests/cases.py, with what they measure
suite: all $(CHECKS)
	@$(PYTHON) tests/run.py --build $(B) --suite --long $(T)
test-long: all $(CHECKS)
	@$(PYTHON) tests/run.py --build $(B) --long $(T)
# what each effect, estimator, adaptor, loop and output brings to a run, and that a run without it has nothing of it, as a table
matrix: all
	@$(PYTHON) tests/effects/matrix.py --build $(B)
# random scenes, and what libFuzzer makes of files; one that goes wrong is printed with the command that repeats it
fuzz: all deps-dev
	@$(PYTHON) tests/fuzz/scenes.py --abut $(B)/bin/abut
	@OMPI_CC=clang MPICH_CC=clang $(MAKE) B=$(B)/fuzz CFLAGS="$(FUZZ_CFLAGS)" $(B)/fuzz/tests/readers
	@$(PYTHON) tests/fuzz/readers.py $(B)/fuzz/tests/readers $(B)/bin/abut --seconds $(FUZZ_SECONDS)
$(B)/tests/readers: $(B)/obj/tests/fuzz/readers.o $(LIB) | all $(B)/tests
	$(LINK) -fsanitize=fuzzer $< -o $@ -L$(B)/lib -labut $(RPATH) $(DEPS_LIBS) -lm
FUZZ_CFLAGS   = -g -O1 -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
FUZZ_SECONDS ?= 60
# which lines of src/ and plugins/ all tests together run; warnings are the business of other builds
coverage: deps-dev
	@mkdir -p $(B)/coverage && find $(B)/coverage -name '*.gcda' -delete
	-$(MAKE) B=$(B)/coverage CFLAGS="-g -O1 --coverage" WARNINGS= test-long
	gcovr --root . --filter src/ --filter plugins/ --exclude plugins/template/ --sort-percentage --fail-under-line 90 $(B)/coverage/obj
# the paper's loop and ours, with all that is written, in the memory checker; the paper's on coarser meshes: the same code in 400 sweeps
MEMCHECK = valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite --show-leak-kinds=definite \
           --num-callers=40 --suppressions=tests/memcheck.supp $(B)/bin/abut $(subst out/,out/memcheck_,$(LAYERS))
memcheck: all deps-dev
	@mkdir -p out
	$(MEMCHECK) -upper_mesh_cells 16,4 -snes_rtol 1e-3 -adaptor_threshold 0.2
	$(MEMCHECK) -snes_type ddactive
asan: # without the leak checker, which reports 122 kB of Open MPI; PETSc finds our own leaks; a test preloads the library of another program
	ABUT_LEAKS=1 ASAN_OPTIONS=detect_leaks=0:verify_asan_link_order=0 UBSAN_OPTIONS=halt_on_error=1 $(MAKE) B=$(B)/asan CFLAGS="-g -O1 -fno-omit-frame-pointer -fsanitize=address,undefined" test

setup: ; @:
deps:
	@tests/deps.sh
deps-dev:
	@config/setup.sh "" contribute install
CLANG_FORMAT ?= $(or $(wildcard .venv/bin/clang-format),clang-format)
SOURCES       = $(shell find include src plugins tests -name '*.[ch]')
format:
	$(CLANG_FORMAT) -i $(SOURCES)
lint:
	$(CLANG_FORMAT) --dry-run -Werror $(SOURCES)
	@! grep -nE '.{141,}' $(SOURCES)

install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/lib/pkgconfig $(DESTDIR)$(PREFIX)/include/abut/private
	install -m 755 $(ABUT) $(DESTDIR)$(PREFIX)/bin
	install -m 755 $(B)/lib/*.so $(DESTDIR)$(PREFIX)/lib
	install -m 644 include/*.h $(DESTDIR)$(PREFIX)/include
	install -m 644 include/abut/private/*.h $(DESTDIR)$(PREFIX)/include/abut/private
	sed 's|@PREFIX@|$(abspath $(PREFIX))|; s|@VERSION@|$(VERSION)|; s|@PETSC@|$(PETSC)|' config/abut.pc.in > $(DESTDIR)$(PREFIX)/lib/pkgconfig/abut.pc
VERSION = $(shell sed -n 's/^version: *//p' CITATION.cff)

clean:
	rm -rf $(B) out
FORCE:
.PHONY: all run study-loops study-shares study-accuracy study-paper study-cost study-compare study-estimators study-scaling test test-long suite matrix fuzz check asan coverage memcheck setup deps deps-dev format lint install clean FORCE
.DELETE_ON_ERROR:
