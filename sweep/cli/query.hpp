// `query`: one read-only statement, with its result as text, csv, json or a workbook.
#pragma once

#include "sweep/report/table.hpp"

#include <string>

namespace grainsweep::cli {

struct QueryRequest {
    std::string database, sql;
    std::string output;    ///< file of the workbook; empty: standard output
    double seconds = 600;  ///< of processor time; 0: no limit
};

/// Runs the query and returns the exit code. Throws InputError for a refused statement, and for a workbook on a
/// terminal.
[[nodiscard]] int query(const QueryRequest& request, report::Format format);

}  // namespace grainsweep::cli
