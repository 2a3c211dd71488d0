// A folder in which tasks without a main program share a campaign: each claims cases, computes them and leaves one
// file for each. Nothing else connects them, and any of them may be killed at any moment.
//
//     campaign                 the campaign file, and what it asks
//     tasks/NAME               of a task that runs: touched again and again; its age says whether it lives
//     cases/ID.N               attempt N at a case: a claim that names its task, until the answer takes its place
//     artefacts/               shared starting states and checkpoints
//
// What is assumed of the file system. open(2) with O_CREAT and O_EXCL makes a file for one caller only (NFS since
// version 3, Lustre, GPFS, BeeGFS, CIFS, every local one); rename(2) replaces a file whole; a file opened anew shows
// what was written before it was closed elsewhere (close-to-open, as NFS gives); the modification times that two nodes
// set differ by less than the lease. Where the first or the last does not hold, a case may be computed twice: its
// answers are equal, and one of them counts. Nothing rests on locks, on memory mappings, or on the age of directory
// listings.
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

/// An attempt that has ended, and what computed it.
struct Answer {
    campaign::CaseResult result;
    campaign::Computer computer;
};
/// A task is at it.
struct Claim {
    std::string task;  ///< empty: not written yet
};
/// No file of a spool, or not whole.
struct Damaged {
    std::string why;
};
using Entry = std::variant<Answer, Claim, Damaged>;

[[nodiscard]] std::string text_of(const Answer& answer);
[[nodiscard]] std::string text_of(const Claim& claim);
[[nodiscard]] Entry entry_in(std::string_view text);

/// The entry that a file of cases/ holds; nothing where it is gone. Damaged, too: what is no regular file of a spool's
/// size, and an answer that the scene cannot give or that belongs to another attempt than the file's name says.
[[nodiscard]] std::optional<Entry> entry_of(const std::filesystem::path& file, const campaign::Attempt& named,
                                            const SceneInfo& scene);

/// A file of cases/. Nothing where the name is none of a spool's.
[[nodiscard]] std::optional<campaign::Attempt> attempt_named(std::string_view file);

/// What a spool is of.
struct Asked {
    std::filesystem::path folder;  ///< where the files lie that the campaign file names
    std::string cases;             ///< hash of the ids in order
    std::string text;              ///< the campaign file
};
[[nodiscard]] std::string hash_of_cases(const campaign::Cases& cases);

class Spool {
public:
    /// Throws WrongQuestion where there is no spool.
    [[nodiscard]] static Asked asked_in(const std::filesystem::path& folder);

    /// Makes the folder where there is none; throws WrongQuestion where it is a spool of other cases, BrokenWorld where
    /// it cannot be written. `scene`: that answers the cases.
    Spool(std::filesystem::path folder, const Asked& asked, const SceneInfo& scene);

    /// Creates the claim; false where something is there.
    [[nodiscard]] bool claim(const campaign::Attempt& attempt, const std::string& task) const;
    /// Nothing where there is no such file.
    [[nodiscard]] std::optional<Entry> read(const campaign::Attempt& attempt) const;
    /// On disk when this returns, in the place of the claim.
    void answer(const Answer& answer) const;
    /// The attempt was never begun: its number is free again.
    void release(const campaign::Attempt& attempt) const;

    [[nodiscard]] std::filesystem::path artefacts() const { return folder_ / "artefacts"; }
    [[nodiscard]] std::filesystem::path cases() const { return folder_ / "cases"; }
    [[nodiscard]] std::filesystem::path task(const std::string& name) const { return folder_ / "tasks" / name; }
    [[nodiscard]] std::filesystem::path file_of(const campaign::Attempt& attempt) const;

private:
    std::filesystem::path folder_;
    const SceneInfo* scene_;
};

/// Makes the file of a running task, and keeps it young; removes it in the end.
class TaskFile {
public:
    /// A task counts as dead if its file is older than `lease` seconds, or if this process has not seen the file change
    /// for that time: a date in the future is no sign of life.
    TaskFile(const Spool& spool, double lease);
    TaskFile(const TaskFile&) = delete;
    TaskFile& operator=(const TaskFile&) = delete;
    ~TaskFile();
    [[nodiscard]] const std::string& name() const { return name_; }
    /// To be called often; touches the file a few times per lease.
    void keep_young(double now);
    enum class State {
        lives,
        renewed,  ///< it has touched its file since it was first looked at
        dead,
    };
    [[nodiscard]] State state_of(const std::string& task);
    /// Of a claim that names no task.
    [[nodiscard]] bool is_abandoned(const campaign::Attempt& attempt);

private:
    /// A file that others touch, as it was seen so far.
    struct Watched {
        std::int64_t first = 0, last = 0;  ///< modification times, ns
        double changed = 0;                ///< when `last` was first seen, s of the steady clock
    };
    void touch();
    /// Whether it is too old, or has not changed for too long; looked at now.
    [[nodiscard]] bool is_silent(const std::filesystem::path& file, std::int64_t modified);
    const Spool& spool_;
    std::string name_;
    std::filesystem::path file_;
    double lease_, touched_ = 0;
    std::map<std::filesystem::path, Watched> watched_;
};

}  // namespace grainsweep::spool
