// SPDX-License-Identifier: MIT
#pragma once

namespace mixloop {

/// Writes out what stdout has buffered. A failure is remembered, for standard_output_failure.
void flush_standard_output();

/// Remembers a failure that was met otherwise.
void remember_output_failure(int error);

/// Writes it out too; the errno of the first failure; 0 where all that was said is written.
int standard_output_failure();

}  // namespace mixloop
