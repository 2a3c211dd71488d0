// `work`: one task of a campaign without a main program, with everything wired together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

struct WorkRequest {
    std::filesystem::path config, spool;
    std::string share;                    ///< "i/n"; empty: that of the Slurm array, or 1/1
    std::optional<std::int64_t> workers;  ///< overrides the file's; 0: all cores
    double lease = 300;
    bool quiet = false;
    std::string path;  ///< instruction path for the workers; empty: each the widest it has
};

struct WorkReport {
    int exit_code = 0;
    std::string campaign;
    std::int64_t part = 1, of = 1;
    std::int64_t cases = 0, answered = 0, computed = 0;
    std::string ending;  ///< one sentence
};

/// Throws WrongQuestion for a campaign whose points follow from answers.
[[nodiscard]] WorkReport work_on(const WorkRequest& request);

}  // namespace grainsweep::cli
