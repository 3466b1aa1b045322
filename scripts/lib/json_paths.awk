# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Reads one JSON document and prints a line "path<TAB>value" for every scalar in it: "surfaces.0.vertices	8214".
# Strings keep their escapes. For reading our own --json output on machines that have nothing but a shell and awk.
{ text = text $0 "\n" }

function skip() { while (substr(text, at, 1) ~ /[ \t\r\n]/) at++ }

function string(   begin) {
    begin = ++at
    while (at <= length(text) && substr(text, at, 1) != "\"") at += substr(text, at, 1) == "\\" ? 2 : 1
    return substr(text, begin, at++ - begin)
}

function value(path,   opening, closing, count, key, begin) {
    skip()
    opening = substr(text, at, 1)
    if (opening == "{" || opening == "[") {
        closing = opening == "{" ? "}" : "]"
        at++
        skip()
        for (count = 0; at <= length(text) && substr(text, at, 1) != closing; count++) {
            key = count
            if (opening == "{") { key = string(); skip(); at++ }
            value(path == "" ? key : path "." key)
            skip()
            if (substr(text, at, 1) == ",") at++
            skip()
        }
        at++
    } else if (opening == "\"") {
        print path "\t" string()
    } else {
        begin = at
        while (at <= length(text) && substr(text, at, 1) !~ /[],} \t\r\n]/) at++
        print path "\t" substr(text, begin, at - begin)
    }
}

END { at = 1; value("") }
