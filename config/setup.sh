#!/bin/sh
# Finds what Abut is built with, installs what is missing where it may, and writes the answers for the Makefile.
#   config/setup.sh FILE.mk build|all|test [install]      config/setup.sh "" contribute install
# build: compilers and libraries; all: also what the tests and pictures need; test: also what some tests can do without; contribute: also format, lint and memory tools.
# Packages are installed only when asked to (install), as root, on a system with apt-get. Nothing here calls sudo.
set -u
config=$1 need=$2 install=${3-}

if [ -n "${PETSC_DIR-}" ]; then
  pkgconfig=$PETSC_DIR/${PETSC_ARCH:+$PETSC_ARCH/}lib/pkgconfig
  [ -f "$pkgconfig/PETSc.pc" ] || [ -f "$pkgconfig/petsc.pc" ] || { echo "No PETSc in PETSC_DIR, PETSC_ARCH: there is no $pkgconfig/PETSc.pc" >&2 && exit 1; }
  export PKG_CONFIG_PATH="$pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
fi
has() { command -v "$1" >/dev/null 2>&1; }
pc() { pkg-config "$@" 2>/dev/null; }
may_install() { [ "$install" = install ] && [ "$(id -u)" = 0 ] && has apt-get; }

# The Python that can draw; Debian's packages belong to /usr/bin/python3, which need not be the first on the path
find_python() {
  for python in python3 /usr/bin/python3 ''; do
    has "$python" && "$python" -c 'import importlib.util as u; exit(not (u.find_spec("matplotlib") and u.find_spec("h5py")))' && break
  done
}

# PETSc and the HDF5 it was built with go by several names
find_flags() {
  CC=mpicc petsc='' cflags='' libs='' check_cflags='' check_libs='' slepc_cflags='' slepc_libs=''
  has pkg-config || return
  for name in PETSc petsc; do pc --exists $name && petsc=$name && break; done
  if [ -n "$petsc" ]; then
    CC=$(pc --variable=ccompiler $petsc)
    has "${CC:=mpicc}" || CC=mpicc
    cflags=$(pc --cflags-only-I $petsc) libs=$(pc --libs $petsc)
    for word in $(pc --static --libs $petsc); do # the estimators call BLAS and LAPACK themselves
      case $word in -lscalapack*) ;; -l*lapack* | -l*blas* | -l*mkl*) libs="$libs $word" ;; esac
    done
    [ -z "${PETSC_DIR-}" ] || libs="$libs -Wl,-rpath,$(pc --variable=libdir $petsc)"
  fi
  for name in hdf5-openmpi hdf5-mpi hdf5; do
    if pc --exists $name; then cflags="$cflags $(pc --cflags-only-I $name)" libs="$libs $(pc --libs $name)" && break; fi
  done
  [ -z "${P4EST_DIR-}" ] || cflags="-I$P4EST_DIR/include $cflags" libs="-L$P4EST_DIR/lib -Wl,-rpath,$P4EST_DIR/lib $libs"
  libs="-lp4est -lsc $libs" cflags="$cflags $(pc --cflags muparser)"
  check_cflags=$(pc --cflags check) check_libs=$(pc --libs check)
  find_slepc
}

# SLEPc is optional, and must belong to this PETSc: a program with both has only one libpetsc
find_slepc() {
  slepc_cflags='' slepc_libs=''
  program=$(mktemp)
  for name in slepc SLEPc; do
    [ -n "$petsc" ] && pc --exists $name || continue
    words="$(pc --libs $name)"
    [ -z "${PETSC_DIR-}" ] || words="$words -Wl,-rpath,$(pc --variable=libdir $name)"
    echo 'int EPSCreate(void); int PetscFinalize(void); int main(void) { return EPSCreate() + PetscFinalize(); }' |
      "$CC" -x c - -o "$program" $words $libs 2>/dev/null || continue
    [ "$(ldd "$program" | grep -c libpetsc)" -le 1 ] || continue
    slepc_cflags="-DABUT_HAVE_SLEPC $(pc --cflags-only-I $name)" slepc_libs=$words
    break
  done
  rm -f "$program"
}

answers() {
  cat <<END
# Written by config/setup.sh; PETSc $(pc --modversion "${petsc:-none}") ${OMPI_CC-}
CC           = $CC
PETSC        = $petsc
DEPS_CFLAGS  = $cflags
DEPS_LIBS    = $libs
CHECK_CFLAGS = $check_cflags
CHECK_LIBS   = $check_libs
SLEPC_CFLAGS = $slepc_cflags
SLEPC_LIBS   = $slepc_libs
PYTHON       = $python
END
}

has_header() { has "$CC" && printf '#include <%s>\n' "$1" | "$CC" $cflags -E - >/dev/null 2>&1; }
has_fuzzer() {
  program=$(mktemp)
  echo 'int LLVMFuzzerTestOneInput(void) { return 0; }' | clang -x c -fsanitize=fuzzer,address,undefined - -o "$program" 2>/dev/null
  status=$?
  rm -f "$program"
  return $status
}
want() { missing="$missing\n  $1" packages="$packages $2"; }

# Everything `need` asks for: what it is called, and the Debian packages that have it
find_missing() {
  missing='' packages=''
  has gcc || has clang || want "a C compiler" "gcc libc6-dev"
  has pkg-config || want "pkg-config" "pkg-config"
  { has "$CC" && has mpiexec; } || want "MPI: mpicc, mpiexec" "libopenmpi-dev openmpi-bin"
  [ -n "$petsc" ] || want "PETSc, real scalars, with hypre, MUMPS and HDF5" "libpetsc-real-dev libhypre-dev"
  has_header hdf5.h || want "HDF5 for MPI" "libhdf5-openmpi-dev"
  has_header p4est.h || want "p4est" "libp4est-dev"
  has_header muParserDLL.h || want "muParser" "libmuparser-dev"
  [ "$need" = build ] && return
  [ -n "$python" ] || want "Python 3 with Matplotlib and h5py" "python3 python3-matplotlib python3-h5py"
  pc --exists check || want "Check, the unit test framework" "check"
  [ "$need" = all ] || "$python" -c 'import ensurepip' 2>/dev/null || want "venv for Python 3" "python3-venv"
  [ "$need" = contribute ] || return
  has_fuzzer || want "clang with libFuzzer" "clang libclang-rt-dev"
  has valgrind || want "valgrind" "valgrind"
  has gcovr || want "gcovr" "gcovr"
}

install_packages() {
  log=$(mktemp)
  export DEBIAN_FRONTEND=noninteractive
  echo "Installing$packages"
  apt-get update >"$log" 2>&1 && apt-get install -y --no-install-recommends $packages >>"$log" 2>&1 && rm "$log" && return
  tail -n 20 "$log" >&2
  echo "apt-get could not install$packages; its whole output is in $log" >&2
  exit 1
}

say_missing() {
  hint=''
  [ "$(id -u)" != 0 ] || hint='You are root: `make setup` does that.
'
  printf 'Missing:%b\n' "$missing" >&2
  cat >&2 <<END
An administrator of a Debian or Ubuntu system installs it with
  apt-get install --no-install-recommends$packages
${hint}Without an administrator, point to what you have:
  make PETSC_DIR=/path/to/petsc PETSC_ARCH=arch    a PETSc of your own: 3.18 or newer, real scalars, 32-bit indices, configured with
                                                   --download-hypre --download-mumps --download-scalapack --download-hdf5
                                                   --download-p4est; without PETSC_ARCH where it is installed
  make P4EST_DIR=/path/to/p4est                    a p4est that PETSc did not bring along
  PKG_CONFIG_PATH=/path/to/lib/pkgconfig make      anything that comes with a .pc file: muparser, check, hdf5
END
  exit 1
}

find_python
find_flags
find_missing
if [ -n "$missing" ] && may_install; then
  install_packages
  find_python
  find_flags
  find_missing
fi
[ -z "$missing" ] || say_missing

# optional PACKAGE: installs it if it may; that there is none is no error
optional() {
  may_install && apt-cache show "$1" >/dev/null 2>&1 || return
  echo "Installing $1, which is optional"
  DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$1" >/dev/null 2>&1
}

[ -n "$slepc_libs${PETSC_DIR-}" ] || { optional libslepc-real-dev && find_slepc; }
# Debian's own BLAS is the reference, with which direct solvers take twice as long
case $(ldconfig -p 2>/dev/null | sed -n 's|.*libblas\.so\.3 .*=> ||p' | head -n 1 | xargs -r readlink -f) in
*/blas/libblas.so.3*) [ -n "${PETSC_DIR-}" ] || optional libopenblas0-serial ;;
esac

# venv IMPORT PACKAGE: a package of PyPI in .venv, which has none of the system's; IMPORT is the line of Python that needs it
venv() {
  .venv/bin/python -c "$1" 2>/dev/null && return
  { [ -x .venv/bin/pip ] || "$python" -m venv .venv; } && .venv/bin/pip install --quiet --no-deps --retries 1 --timeout 20 "$2"
}

if [ "$need" = test ] && [ "$install" = install ]; then # Debian's python3-vtk9 has no reader of XDMF
  venv 'import vtkmodules.vtkIOXdmf2' vtk==9.4.2 2>/dev/null || echo "No VTK for Python from PyPI, which is optional"
fi

if [ "$need" = contribute ]; then # the version .clang-format is written for; Debian 12 has 14, which cannot read it
  venv 'import clang_format' clang-format==18.1.8
elif ! answers | cmp -s - "$config"; then
  mkdir -p "$(dirname "$config")"
  answers >"$config"
fi
