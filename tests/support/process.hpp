// Real processes for tests of the real executable.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace grainsweep::tests {

struct Ended {
    int code = -1;  ///< exit code, or 128 + signal
    std::string out, err;
    long most_memory = 0;  ///< resident at once, of it or one of the processes it waited for, MB
};

/// A child process whose output goes to files in a folder of its own; killed when it goes out of scope.
class Process {
public:
    Process(const std::vector<std::string>& argv, const std::filesystem::path& folder);
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    [[nodiscard]] pid_t pid() const { return pid_; }
    [[nodiscard]] bool running();
    void signal(int number) const;
    Ended wait();
    /// Processes whose parent is this one.
    [[nodiscard]] std::vector<pid_t> children() const;

private:
    void reap(int options);

    pid_t pid_ = -1;
    int status_ = 0;
    long most_memory_ = 0;
    bool reaped_ = false;
    std::filesystem::path out_, err_;
};

/// Runs grainsweep with the arguments, to its end, in `folder`.
Ended run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
[[nodiscard]] std::vector<std::string> program_command(const std::vector<std::string>& arguments);

/// Processes whose command line contains `text`.
[[nodiscard]] std::vector<pid_t> processes_with(const std::string& text);

/// A folder in memory, where no test waits for a disk, if it has a gigabyte of room and may hold programs; else the
/// system's folder of temporary files.
[[nodiscard]] std::filesystem::path in_memory();

/// A new empty folder, removed at the end of the test program's life of this object.
class Folder {
public:
    explicit Folder(const std::filesystem::path& parent = in_memory());
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::filesystem::path write(const std::string& name, const std::string& text) const;

private:
    std::filesystem::path path_;
};

}  // namespace grainsweep::tests
