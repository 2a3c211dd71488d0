// The real program with one system call in it that goes wrong, once: it is killed there, the call fails, or takes long.
#pragma once

#include "tests/support/process.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grainsweep::tests {

/// Which call of which process; the words are those of tests/preload/failing_calls.cpp.
struct FailingCall {
    std::string who;   ///< "main" or "worker"
    std::string call;  ///< "open", "write", "read", "sync", "truncate", "rename", "remove" or "exec"
    std::string file;  ///< end of the file's name, or "pipe"
    std::string when = "before";
    int number = 1;             ///< the so-many-th of the process
    std::string what = "kill";  ///< "kill", seconds, or an errno below zero

    [[nodiscard]] std::string name() const;
};

/// The command of the program with the call in it. It happens once, in whatever run of `token` comes first.
[[nodiscard]] std::vector<std::string> command_with(const FailingCall& call, const std::filesystem::path& token,
                                                    const std::vector<std::string>& arguments);
/// Whether the call of that token has gone wrong.
[[nodiscard]] bool has_happened(const std::filesystem::path& token);

/// Log of the write-ahead logs that processes started during its life remove.
class RemovedLogs {
public:
    explicit RemovedLogs(const std::filesystem::path& folder);
    ~RemovedLogs();
    RemovedLogs(const RemovedLogs&) = delete;
    RemovedLogs& operator=(const RemovedLogs&) = delete;
    /// Returns how many files were removed so far while another process had them open.
    [[nodiscard]] int in_use() const { return count("in use "); }
    /// Returns how many files were removed that nothing else had open.
    [[nodiscard]] int free() const { return count("free "); }

private:
    [[nodiscard]] int count(const std::string& word) const;

    std::filesystem::path file_;
};

/// A campaign of a few cases that save themselves after every slice, and what must hold of it after any misfortune.
class SmallCampaign {
public:
    static constexpr int cases = 4, workers = 2;

    SmallCampaign();
    /// The same with other members of its file.
    explicit SmallCampaign(const std::string& execution);

    struct Trial {
        bool happened = false;
        Ended disturbed;        ///< the run that the call belonged to
        std::string complaint;  ///< of what does not hold after the next run without it; empty: all holds
    };
    /// A run with the call in it, into a new database, and one without it.
    [[nodiscard]] Trial attempt(const FailingCall& call) const;
    [[nodiscard]] const Folder& folder() const { return folder_; }

private:
    [[nodiscard]] std::vector<std::string> run_into(const std::string& database) const;
    [[nodiscard]] std::string complaint_of(const FailingCall& call, const std::string& database) const;

    Folder folder_;
    std::string undisturbed_;
};

}  // namespace grainsweep::tests
