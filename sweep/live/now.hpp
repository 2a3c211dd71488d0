// What a run does at this moment, for readers beside it: a small text file beside the database, written anew each
// second and gone when the run ends. It is a help, no record: a file that was not written lately says nothing, and an
// error while it is written is passed over.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::live {

/// A case that a worker has.
struct RunningCase {
    std::string case_id;
    std::int64_t attempt = 0;
    std::optional<double> share;  ///< done, 0 to 1; none: not known
    double seconds = 0;           ///< since it was handed out
    std::string host;
};

struct Now {
    std::string campaign, host;
    std::int64_t process = 0;  ///< its number on that host
    std::int64_t questions = 0, decided = 0, failed = 0;
    std::int64_t settled = 0;  ///< results of this run on disk
    double seconds = 0;        ///< since the run began
    double seconds_left = 0;   ///< until its expected end
    bool at_most = false;      ///< it may end sooner
    std::string judgement;     ///< last verdict on convergence
    std::vector<RunningCase> running;
};

/// "x.now" for x.db, in its folder.
[[nodiscard]] std::filesystem::path now_file(const std::filesystem::path& database);

void write_now(const std::filesystem::path& file, const Now& now);
/// What the file says; none where there is no such file, it was not written for ten seconds, or it is no such text.
[[nodiscard]] std::optional<Now> read_now(const std::filesystem::path& database);

[[nodiscard]] std::string text_of(const Now& now);
[[nodiscard]] std::optional<Now> now_of(std::string_view text);

}  // namespace grainsweep::live
