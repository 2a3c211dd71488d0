// Spool: a folder in which tasks without a main program share a campaign. Each task claims cases, computes them and
// writes one file per case. Tasks communicate only by these files, and may be killed at any moment.
//
//     campaign                 the campaign file and the requested cases
//     tasks/NAME               file of a running task, touched repeatedly; its age shows whether the task lives
//     cases/ID.N               attempt N at a case: a claim with the name of its task, later replaced by the answer
//     artefacts/               shared starting states and checkpoints
//
// Assumptions about the file system:
//
//     open(2) with O_CREAT and O_EXCL makes a file for one caller only (NFS since version 3, Lustre, GPFS, BeeGFS,
//       CIFS, all local ones)
//     rename(2) replaces a file completely
//     a newly opened file shows all data written before another process closed it (close-to-open, as NFS guarantees)
//     modification times set by two nodes differ by less than the lease
//
// Where the first or the last does not hold, a case may be computed twice: its answers are equal, and one of them
// counts. Locks, memory mappings and fresh directory listings are not needed.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/cases.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::spool {

/// Finished attempt, with its program and machine.
struct Answer {
    campaign::CaseResult result;
    campaign::Computer computer;
};
/// Claim of a running task.
struct Claim {
    std::string task;  ///< name; empty: not written yet
};
/// File that is no entry of a spool, or incomplete.
struct Damaged {
    std::string why;
};
using Entry = std::variant<Answer, Claim, Damaged>;

[[nodiscard]] std::string text_of(const Answer& answer);
[[nodiscard]] std::string text_of(const Claim& claim);
[[nodiscard]] Entry entry_in(std::string_view text);

/// Returns the entry in a file of cases/; empty if there is no file. Damaged also means: no regular file of a plausible
/// size, an answer that the scene cannot give, or an answer of another attempt than the file's name.
[[nodiscard]] std::optional<Entry> entry_of(const std::filesystem::path& file, const campaign::Attempt& named,
                                            const SceneInfo& scene);

/// Returns the attempt of a file name in cases/; empty if the name is invalid.
[[nodiscard]] std::optional<campaign::Attempt> attempt_named(std::string_view file);

/// Campaign of a spool.
struct Asked {
    std::filesystem::path folder;  ///< folder of the files that the campaign file names
    std::string cases;             ///< hash of the ids in order
    std::string text;              ///< the campaign file
};
[[nodiscard]] std::string hash_of_cases(const campaign::Cases& cases);

class Spool {
public:
    /// Reads the campaign of a spool. Throws InputError if there is no spool.
    [[nodiscard]] static Asked asked_in(const std::filesystem::path& folder);

    /// Makes the folder if there is none. Throws InputError if it is a spool of other cases, SystemError if it
    /// cannot be written. `scene`: scene of the cases.
    Spool(std::filesystem::path folder, const Asked& asked, const SceneInfo& scene);

    /// Creates the claim. Returns false if the file exists.
    [[nodiscard]] bool claim(const campaign::Attempt& attempt, const std::string& task) const;
    /// Reads the entry of an attempt; empty if there is no such file.
    [[nodiscard]] std::optional<Entry> read(const campaign::Attempt& attempt) const;
    /// Replaces the claim by the answer; it is on disk when this returns.
    void answer(const Answer& answer) const;
    /// Removes the claim of an attempt that was never begun; its number is free again.
    void release(const campaign::Attempt& attempt) const;

    [[nodiscard]] std::filesystem::path artefacts() const { return folder_ / "artefacts"; }
    [[nodiscard]] std::filesystem::path cases() const { return folder_ / "cases"; }
    [[nodiscard]] std::filesystem::path task(const std::string& name) const { return folder_ / "tasks" / name; }
    [[nodiscard]] std::filesystem::path file_of(const campaign::Attempt& attempt) const;

private:
    std::filesystem::path folder_;
    const SceneInfo* scene_;
};

/// File of a running task, which is touched repeatedly and removed at the end.
class TaskFile {
public:
    /// `lease`: a task counts as dead if its file is older than this, s. It is dead also if the file did not change for
    /// this time while watched, so a date in the future is no sign of life.
    TaskFile(const Spool& spool, double lease);
    TaskFile(const TaskFile&) = delete;
    TaskFile& operator=(const TaskFile&) = delete;
    ~TaskFile();
    [[nodiscard]] const std::string& name() const { return name_; }
    /// Touches the file a few times per lease; must be called often.
    void keep_young(double now);
    enum class State {
        lives,
        renewed,  ///< it has touched its file since the first check
        dead,
    };
    [[nodiscard]] State state_of(const std::string& task);
    /// Returns whether a claim without the name of a task is abandoned.
    [[nodiscard]] bool is_abandoned(const campaign::Attempt& attempt);

private:
    /// File of another task, with the times seen so far.
    struct Watched {
        std::int64_t first = 0, last = 0;  ///< modification times, ns
        double changed = 0;                ///< when `last` was first seen, s of the steady clock
    };
    void touch();
    /// Returns whether the file is too old now, or has not changed for too long.
    [[nodiscard]] bool is_silent(const std::filesystem::path& file, std::int64_t modified);
    const Spool& spool_;
    std::string name_;
    std::filesystem::path file_;
    double lease_, touched_ = 0;
    std::map<std::filesystem::path, Watched> watched_;
};

}  // namespace grainsweep::spool
