// Jobs requested by a page (a film, an answer to SQL), each in a process of low priority. They end with this object.
#pragma once

#include "sweep/files/descriptor.hpp"

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::live {

class Jobs {
public:
    Jobs() = default;
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;
    ~Jobs() { end(); }
    /// Kills every job.
    void end();

    /// Limits of a job.
    struct Bounds {
        std::size_t most_at_once = 4;  ///< most jobs at the same time
        std::int64_t most_bytes = 0;   ///< largest size of its output file
    };
    /// Runs this program with these arguments. Returns the number of the job; empty if too many are running or it
    /// cannot be started.
    [[nodiscard]] std::optional<std::int64_t> start(const std::vector<std::string>& arguments,
                                                    const std::filesystem::path& folder, const Bounds& bounds);
    struct Ended {
        int code = 0;
        std::string out, err;
    };
    struct State {
        bool known = false;
        std::optional<Ended> ended;
    };
    /// Returns the state of a job; removes the job if it has ended.
    [[nodiscard]] State look_at(std::int64_t number);
    [[nodiscard]] bool is_running(std::int64_t number);

private:
    struct Job {
        pid_t process = 0;
        files::Descriptor out, err;
        std::optional<int> code = {};  ///< exit code, once it has ended
        /// Returns whether it still runs.
        [[nodiscard]] bool goes_on();
    };
    static constexpr std::size_t most_kept = 16;  ///< most ended jobs that are kept
    std::map<std::int64_t, Job> jobs_;
    std::int64_t last_ = 0;
};

/// Folder with permissions for this user alone. The destructor removes it.
class PrivateFolder {
public:
    /// Throws SystemError if it cannot be made.
    PrivateFolder();
    PrivateFolder(const PrivateFolder&) = delete;
    PrivateFolder& operator=(const PrivateFolder&) = delete;
    ~PrivateFolder() { remove(); }
    void remove();
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// Run that a page started. It continues after this object ends, like a run started from a shell.
class Runner {
public:
    /// Starts a run; standard output and error are written to x.run.log beside the database x.db, a new file that
    /// takes the place of an old one or of a link. Returns false if it cannot be started.
    [[nodiscard]] bool start(const std::vector<std::string>& arguments, const std::filesystem::path& database);
    [[nodiscard]] bool running();

private:
    std::optional<pid_t> process_;
};

}  // namespace grainsweep::live
