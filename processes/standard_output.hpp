// SPDX-License-Identifier: MIT
#pragma once

namespace mixloop {

/// Opens on /dev/null what this process was started without of stdin, stdout and stderr: else the first log
/// or result would take its place, and what is said would go there. Before anything else is opened.
void open_standard_files();

/// Writes out what stdout has buffered. A failure is remembered, for standard_output_failure.
void flush_standard_output();

/// Remembers a failure that was met otherwise.
void remember_output_failure(int error);

/// Writes it out too; the errno of the first failure; 0 where all that was said is written.
int standard_output_failure();

}  // namespace mixloop
