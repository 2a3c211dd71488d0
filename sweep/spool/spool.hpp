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
#include <vector>

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
    /// it cannot be written.
    Spool(std::filesystem::path folder, const Asked& asked);

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
    /// Seconds since a claim that names no task was made, by the clock of the file system; 0 where it is gone.
    [[nodiscard]] double age_of(const campaign::Attempt& attempt, const std::filesystem::path& touched_now) const;

private:
    [[nodiscard]] std::filesystem::path file_of(const campaign::Attempt& attempt) const;
    std::filesystem::path folder_;
};

/// Makes the file of a running task, and keeps it young; removes it in the end.
class TaskFile {
public:
    /// A task whose file is older than `lease` seconds is taken for dead.
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
    void touch();
    const Spool& spool_;
    std::string name_;
    std::filesystem::path file_;
    double lease_, touched_ = 0;
    std::map<std::string, std::int64_t, std::less<>> first_seen_;  ///< modification times, ns
};

}  // namespace grainsweep::spool
