#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# usage: config_page.sh GLINTD VERSION
# Prints the manual page of glint.toml: each key as `glintd --print-config` tells of it.
set -euo pipefail
glintd=$1
version=$2
cat <<END
.TH GLINT.TOML 5 "" "glint $version" "File formats"
.SH NAME
glint.toml \- configuration of glintd
.SH DESCRIPTION
.I /etc/glint/glint.toml
is read first, then, in order of their names, the files
.I /etc/glint/glint.toml.d/*.toml ,
whose values count instead. A key that is not known or a value that cannot be is an error that names file and line;
.B glintd \-\-check\-config
tells it before a restart, and
.B glint config
tells which value holds and where it is from. What is said here of a key stands before it with its default.
.SH KEYS
.nf
END
"$glintd" --config /dev/null --print-config | sed -e 's/\\/\\e/g' -e "s/'/\\\\(aq/g" -e 's/-/\\-/g' -e 's/^\./\\\&./' | fold -s -w 100
cat <<END
.fi
.SH SEE ALSO
.BR glintd (8),
.BR glint (1)
END
