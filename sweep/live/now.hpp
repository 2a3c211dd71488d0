// Present state of a run, for other programs: a small text file beside the database, written every second and removed
// at the end of the run. It is not reliable: an old file is ignored, and so are errors of writing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::live {

/// Case of a worker.
struct RunningCase {
    std::string case_id;
    std::int64_t attempt = 0;
    std::optional<double> share;  ///< share done, 0 to 1; empty: unknown
    double seconds = 0;           ///< since it was given to the worker
    std::string host;
};

struct Now {
    std::string campaign, host;
    std::int64_t process = 0;  ///< id of its process on this host
    std::int64_t questions = 0, decided = 0, failed = 0;
    std::int64_t settled = 0;  ///< results of this run on disk
    double seconds = 0;        ///< since the run began
    double seconds_left = 0;   ///< until its expected end
    bool at_most = false;      ///< it may end sooner
    std::string judgement;     ///< last verdict on convergence
    std::vector<RunningCase> running;
};

/// Returns "x.now" for x.db, in its folder.
[[nodiscard]] std::filesystem::path now_file(const std::filesystem::path& database);

void write_now(const std::filesystem::path& file, const Now& now);
/// Returns the contents of the file. Empty if there is no regular file, it is invalid or larger than 1 MiB, its time is
/// not within ten seconds of the present, or its process has ended on this host.
[[nodiscard]] std::optional<Now> read_now(const std::filesystem::path& database);

[[nodiscard]] std::string text_of(const Now& now);
[[nodiscard]] std::optional<Now> now_of(std::string_view text);

}  // namespace grainsweep::live
