// Loaded into the program by LD_PRELOAD: at one system call of one process the process is killed, the call fails, or it
// takes long. The program has no part in it. tests/support/failing_call.hpp prepares what stands in the environment:
//
//   GRAINSWEEP_FAILING_CALL="WHO CALL FILE NUMBER WHEN WHAT TOKEN"
//     WHO     main (program) or worker
//     CALL    open (to write), write, read, sync, truncate, rename, remove, or exec (in the process that main forked)
//     FILE    end of the file's name, of a rename the old one; pipe: any pipe
//     NUMBER  at the so-many-th such call of the process
//     WHEN    before the call, or after it has succeeded
//     WHAT    kill, the seconds it takes, or the errno it fails with, as -28
//     TOKEN   file that is removed when it happens, so that it happens once, in the process that comes first
//
//   GRAINSWEEP_REMOVED_LOGS=FILE  a line for each write-ahead log of SQLite, or its index, that the process removes:
//     "in use" if another process has it open, else "free", and its name
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace {

struct Order {
    bool valid = false;
    char call[16] = {}, file[64] = {}, when[16] = {}, what[16] = {}, token[512] = {};
    int number = 0;
};

bool is_worker() {
    char words[256] = {};
    const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, "/proc/self/cmdline", O_RDONLY | O_CLOEXEC, 0));
    const long length = syscall(SYS_read, file, words, sizeof words - 1);
    syscall(SYS_close, file);
    const std::size_t first = std::strlen(words) + 1;
    return length > static_cast<long>(first) && std::string_view(words + first) == "worker";
}

Order read_order() {
    Order order;
    char who[16] = {};
    const char* text = std::getenv("GRAINSWEEP_FAILING_CALL");
    if (text == nullptr || std::string_view(program_invocation_short_name) != "grainsweep") return order;
    order.valid = std::sscanf(text, "%15s %15s %63s %d %15s %15s %511s", who, order.call, order.file, &order.number,
                              order.when, order.what, order.token) == 7 &&
                  (std::string_view(who) == "worker") == is_worker();
    return order;
}

const Order& order() {
    static const Order read = read_order();
    return read;
}

bool name_fits(std::string_view name) {
    const std::string_view wanted = order().file;
    return wanted == "pipe" ? name.starts_with("pipe:") : name.ends_with(wanted);
}

bool name_fits(int descriptor) {
    char link[64], name[1024];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const long length = syscall(SYS_readlink, link, name, sizeof name);
    return length > 0 && name_fits(std::string_view(name, static_cast<std::size_t>(length)));
}

/// Whether it is to happen now: at this call, once over all processes.
template <class File>
bool is_due(std::string_view call, File file, std::string_view when) {
    static std::atomic<int> count = 0;
    if (!order().valid || call != order().call || when != order().when || !name_fits(file)) return false;
    return ++count == order().number && syscall(SYS_unlink, order().token) == 0;
}

/// The errno that the call is to fail with; 0: none.
int happen() {
    if (std::string_view(order().what) == "kill") syscall(SYS_kill, getpid(), SIGKILL);
    const int number = std::atoi(order().what);
    if (number < 0) return -number;
    // As a call that waits for a dead server: no signal that the process handles ends it.
    timespec left{number, 0};
    while (syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, 0, &left, &left) != 0 && errno == EINTR) {
    }
    return 0;
}

template <class File, class Do>
long guarded(std::string_view call, File file, Do&& perform) {
    if (is_due(call, file, "before")) {
        if (const int number = happen(); number != 0) {
            errno = number;
            return -1;
        }
    }
    const long result = perform();
    const int kept = errno;
    const bool done = call == "read" ? result > 0 : result >= 0;
    if (done && is_due(call, file, "after")) happen();
    errno = kept;
    return result;
}

int opened(const char* path, int flags, unsigned mode) {
    const auto perform = [&] { return syscall(SYS_openat, AT_FDCWD, path, flags, mode); };
    const bool to_write = (flags & (O_WRONLY | O_RDWR)) != 0;
    return static_cast<int>(to_write ? guarded("open", std::string_view(path), perform) : perform());
}

/// Returns whether a process other than this one has the file open.
bool is_open_elsewhere(const char* file) {
    namespace fs = std::filesystem;
    std::error_code error, none;
    const std::string self = std::to_string(getpid());
    for (fs::directory_iterator process("/proc", error), end; !error && process != end; process.increment(error)) {
        const std::string name = process->path().filename();
        if (name == self || name.find_first_not_of("0123456789") != std::string::npos) continue;
        for (fs::directory_iterator open(process->path() / "fd", none); !none && open != end; open.increment(none))
            if (fs::equivalent(open->path(), file, none)) return true;
    }
    return false;
}

void note_removal(const char* path) {
    static const char* const log = std::getenv("GRAINSWEEP_REMOVED_LOGS");
    const std::string_view name(path);
    if (log == nullptr || !(name.ends_with("-wal") || name.ends_with("-shm")) || access(path, F_OK) != 0) return;
    const std::string line = (is_open_elsewhere(path) ? "in use " : "free ") + std::string(name) + "\n";
    const int file =
        static_cast<int>(syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
    syscall(SYS_write, file, line.data(), line.size());
    syscall(SYS_close, file);
}

unsigned mode_in(int flags, va_list& more) {
    return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, unsigned) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const unsigned mode = mode_in(flags, more);
    va_end(more);
    return opened(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const unsigned mode = mode_in(flags, more);
    va_end(more);
    return opened(path, flags, mode);
}
ssize_t write(int file, const void* from, size_t n) {
    return guarded("write", file, [&] { return syscall(SYS_write, file, from, n); });
}
ssize_t writev(int file, const iovec* from, int n) {
    return guarded("write", file, [&] { return syscall(SYS_writev, file, from, n); });
}
ssize_t pwrite64(int file, const void* from, size_t n, off64_t at) {
    return guarded("write", file, [&] { return syscall(SYS_pwrite64, file, from, n, at); });
}
ssize_t read(int file, void* into, size_t n) {
    return guarded("read", file, [&] { return syscall(SYS_read, file, into, n); });
}
ssize_t readv(int file, const iovec* into, int n) {
    return guarded("read", file, [&] { return syscall(SYS_readv, file, into, n); });
}
int fsync(int file) {
    return static_cast<int>(guarded("sync", file, [&] { return syscall(SYS_fsync, file); }));
}
int fdatasync(int file) {
    return static_cast<int>(guarded("sync", file, [&] { return syscall(SYS_fdatasync, file); }));
}
int ftruncate64(int file, off64_t length) {
    return static_cast<int>(guarded("truncate", file, [&] { return syscall(SYS_ftruncate, file, length); }));
}
int rename(const char* from, const char* to) noexcept {
    return static_cast<int>(guarded("rename", std::string_view(from), [&] { return syscall(SYS_rename, from, to); }));
}
int execve(const char* path, char* const arguments[], char* const environment[]) noexcept {
    return static_cast<int>(
        guarded("exec", std::string_view(path), [&] { return syscall(SYS_execve, path, arguments, environment); }));
}
int unlink(const char* path) noexcept {
    note_removal(path);
    return static_cast<int>(guarded("remove", std::string_view(path), [&] { return syscall(SYS_unlink, path); }));
}
int remove(const char* path) noexcept {
    return static_cast<int>(guarded("remove", std::string_view(path), [&] {
        const long removed = syscall(SYS_unlink, path);
        return removed != 0 && (errno == EISDIR || errno == EPERM) ? syscall(SYS_rmdir, path) : removed;
    }));
}

}  // extern "C"

/// GRAINSWEEP_CLOCK_SET_BACK=SECONDS: by so many the clock of the day is set back, 0.3 s after it is first read.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
    static const char* const seconds = std::getenv("GRAINSWEEP_CLOCK_SET_BACK");
    const int result = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
    if (seconds == nullptr || clock != CLOCK_REALTIME) return result;
    static std::atomic<long> first = 0;
    timespec now{};
    syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
    const long milliseconds = now.tv_sec * 1000 + now.tv_nsec / 1'000'000;
    long none = 0;
    first.compare_exchange_strong(none, milliseconds);
    if (milliseconds - first > 300) time->tv_sec -= std::atol(seconds);
    return result;
}
