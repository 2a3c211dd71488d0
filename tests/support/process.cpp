#include "tests/support/process.hpp"

#include "tests/support/places.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace grainsweep::tests {
namespace {

namespace fs = std::filesystem;

/// What can be read of it: of a process that ends meanwhile, nothing. (An iterator over the stream would throw then.)
std::string contents(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return std::move(text).str();
}

std::atomic<int> serial = 0;

}  // namespace

Process::Process(const std::vector<std::string>& argv, const fs::path& folder) {
    const std::string tag = std::to_string(::getpid()) + "_" + std::to_string(serial++);
    out_ = folder / ("out_" + tag);
    err_ = folder / ("err_" + tag);
    std::vector<char*> pointers;
    for (const auto& word : argv) pointers.push_back(const_cast<char*>(word.c_str()));
    pointers.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("fork failed");
    if (pid_ == 0) {
        const int out = ::open(out_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
        const int err = ::open(err_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
        const int null = ::open("/dev/null", O_RDONLY);
        ::dup2(null, 0);
        ::dup2(out, 1);
        ::dup2(err, 2);
        if (::chdir(folder.c_str()) != 0) ::_exit(126);
        ::execv(pointers[0], pointers.data());
        ::_exit(127);
    }
}

Process::~Process() {
    if (!reaped_) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, &status_, 0);
    }
}

bool Process::running() {
    if (reaped_) return false;
    reap(WNOHANG);
    return !reaped_;
}

void Process::reap(int options) {
    rusage usage{};
    if (::wait4(pid_, &status_, options, &usage) != pid_) return;
    reaped_ = true;
    most_memory_ = usage.ru_maxrss / 1024;
}

void Process::signal(int number) const {
    if (!reaped_) ::kill(pid_, number);
}

Ended Process::wait() {
    if (!reaped_) reap(0);
    const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    return {code, contents(out_), contents(err_), most_memory_};
}

std::vector<pid_t> Process::children() const {
    std::vector<pid_t> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename();
        if (!std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; })) continue;
        const std::string stat = contents(entry.path() / "stat");
        const auto after = stat.rfind(')');
        if (after == std::string::npos) continue;
        pid_t parent = 0;
        if (std::sscanf(stat.c_str() + after + 1, " %*c %d", &parent) == 1 && parent == pid_) {
            found.push_back(std::stoi(name));
        }
    }
    return found;
}

std::vector<std::string> program_command(const std::vector<std::string>& arguments) {
    std::vector<std::string> argv = {tests::executable()};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    return argv;
}

Ended run_program(const std::vector<std::string>& arguments, const fs::path& folder) {
    return Process(program_command(arguments), folder).wait();
}

std::vector<pid_t> processes_with(const std::string& text) {
    std::vector<pid_t> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename();
        if (!std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; })) continue;
        std::string command = contents(entry.path() / "cmdline");
        std::ranges::replace(command, '\0', ' ');
        if (command.find(text) != std::string::npos) found.push_back(std::stoi(name));
    }
    return found;
}

fs::path in_memory() {
    const char* memory = "/dev/shm";
    struct statvfs system {};
    const bool suitable = ::access(memory, W_OK) == 0 && ::statvfs(memory, &system) == 0 &&
                          (system.f_flag & ST_NOEXEC) == 0 && system.f_bavail * system.f_frsize > (1UL << 30U);
    return suitable ? fs::path(memory) : fs::temp_directory_path();
}

Folder::Folder(const fs::path& parent) {
    std::string name = (parent / "grainsweep_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder for the test");
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

fs::path Folder::write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
}

}  // namespace grainsweep::tests
