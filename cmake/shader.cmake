# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Writes a shader as a string of C.
#
# cmake -DNAME=name -DSOURCE=name.glsl -DMADE=name.c -P shader.cmake
file(READ "${SOURCE}" text)
string(REPLACE "\\" "\\\\" text "${text}")
string(REPLACE "\"" "\\\"" text "${text}")
string(REPLACE "\n" "\\n\"\n    \"" text "${text}")
file(WRITE "${MADE}" "#include \"gl/shaders.h\"\n\nconst char ewa_shader_${NAME}[] =\n    \"${text}\";\n")
