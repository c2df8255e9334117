// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>

#include "sweep/column_file.hpp"
#include "sweep/sweep.hpp"

namespace mixloop {

/// What a sweep's table is made of, run by run: KeptRuns::each.
using EachRun = std::function<void(const std::function<void(const Outcome&)>& told)>;

/// Writes the table as CSV (RFC 4180), a row a run in their order: run, what was varied, how it ended, what
/// was measured, in SI but for what was varied, whose unit is the one that was written; what was never
/// measured is empty. Numbers read back to the same double. Rows are never held. Throws
/// RunFault("cannot_write").
void write_csv(const std::filesystem::path& file, const Sweep& sweep, const EachRun& each);

/// The same by a module: as HDF5 a chunked dataset a column, its unit as an attribute. Throws
/// RunFault("cannot_write").
void write_columns(const std::filesystem::path& file, const Sweep& sweep, const EachRun& each,
                   WriteColumns write);

}  // namespace mixloop
