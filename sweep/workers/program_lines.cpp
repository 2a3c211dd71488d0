#include "sweep/workers/program_lines.hpp"

#include "sweep/files/broken_world.hpp"
#include "sweep/workers/program_answerer.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace grainsweep::workers {
namespace {

constexpr std::size_t longest_reply = std::size_t{16} << 20U;
constexpr off_t longest_log = off_t{1} << 20U;
constexpr int look_milliseconds = 100;

struct Pipe {
    Pipe() {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0)
            throw BrokenWorld(fmt::format("no pipe to a program: {}", std::strerror(errno)));
        from = files::Descriptor(ends[0]);
        to = files::Descriptor(ends[1]);
    }
    files::Descriptor from, to;
};

void add_flag(const files::Descriptor& descriptor, int flag) {
    ::fcntl(descriptor.number(), F_SETFL, ::fcntl(descriptor.number(), F_GETFL) | flag);
}

}  // namespace

ProgramLines::ProgramLines(const campaign::Program& program, const std::filesystem::path& cases, ProgramGuard& guard)
    : folder_(cases / fmt::format("alive.{}{}", ::getpid(), running_suffix)) {
    std::signal(SIGPIPE, SIG_IGN);  // a write to one that ended is an error code
    fill_folder(folder_, program, nullptr);
    ProcessStart start{program_argv(program, nullptr)};
    start.environment = program_environment(program, nullptr);
    start.folder = folder_.descriptor();
    log_ = folder_.create("stderr.txt");
    add_flag(log_, O_APPEND);  // it is cut now and then
    Pipe question, reply;
    start.streams = {question.from.number(), reply.to.number(), log_.number()};
    start.memory = program.memory;
    start.file = program.disk;
    try {
        process_ = std::make_unique<ProgramProcess>(start, guard);
    } catch (const std::runtime_error& error) {
        throw BrokenWorld(error.what());
    }
    in_ = std::move(question.to);
    out_ = std::move(reply.from);
    add_flag(in_, O_NONBLOCK);
    add_flag(out_, O_NONBLOCK);
    status_ = files::Descriptor(::open(fmt::format("/proc/{}/status", process_->id()).c_str(), O_RDONLY | O_CLOEXEC));
}

void ProgramLines::end() {
    (void)in_.close();
    if (!process_->wait(0.05)) process_->end();
}

bool ProgramLines::ended_well() {
    constexpr double time_to_end = 1;
    return process_->wait(time_to_end) && process_->result().status == 0;
}

bool ProgramLines::take_line() {
    const auto end = received_.find('\n', searched_);
    searched_ = received_.size();
    if (end == std::string::npos) return false;
    line_ = received_.substr(0, end);
    received_.erase(0, end + 1);
    searched_ = 0;
    return true;
}

/// Writes as much as the pipe accepts, and reads all that it contains.
std::optional<ProgramLines::Heard> ProgramLines::exchange(std::string_view& rest, int milliseconds) {
    std::array<pollfd, 2> ends = {pollfd{out_.number(), POLLIN, 0},
                                  pollfd{rest.empty() ? -1 : in_.number(), POLLOUT, 0}};
    if (::poll(ends.data(), ends.size(), milliseconds) <= 0) return std::nullopt;
    if (ends[1].revents != 0) {
        const auto length = ::write(in_.number(), rest.data(), rest.size());
        if (length > 0) rest.remove_prefix(static_cast<std::size_t>(length));
        if (length < 0 && errno != EAGAIN && errno != EINTR) rest = {};  // it has ended, or closed its input
    }
    if (ends[0].revents == 0) return std::nullopt;
    std::array<char, 65536> piece{};
    const auto length = ::read(out_.number(), piece.data(), piece.size());
    if (length == 0) return Heard::end;
    if (length < 0) return errno == EAGAIN || errno == EINTR ? std::nullopt : std::optional(Heard::end);
    received_.append(piece.data(), static_cast<std::size_t>(length));
    if (take_line()) return Heard::reply;
    return received_.size() > longest_reply ? std::optional(Heard::too_long) : std::nullopt;
}

ProgramLines::Heard ProgramLines::ask(const std::string& question, const std::function<Go()>& look) {
    shorten_log();
    std::string_view nothing;
    line_.clear();
    if (received_.empty() && exchange(nothing, 0) == Heard::end) return Heard::ended_before;
    if (!received_.empty() || !line_.empty()) {
        line_ = shortened(line_.empty() ? received_ : line_, 200);
        return Heard::unasked;
    }
    const std::string text = question + "\n";
    std::string_view rest = text;
    while (true) {
        if (const auto heard = exchange(rest, look_milliseconds)) return *heard;
        const auto go = look();
        if (go != Go::on) return go == Go::stop ? Heard::stopped : Heard::given_up;
    }
}

void ProgramLines::shorten_log() const {
    if (::lseek(log_.number(), 0, SEEK_END) > longest_log) (void)!::ftruncate(log_.number(), 0);
}

double ProgramLines::peak_memory() const {
    std::array<char, 4096> text{};
    const auto length = ::pread(status_.number(), text.data(), text.size() - 1, 0);
    if (length <= 0) return std::numeric_limits<double>::quiet_NaN();
    const std::string_view all(text.data(), static_cast<std::size_t>(length));
    constexpr std::string_view name = "VmHWM:";
    const auto at = all.find(name);
    const auto digit = at == std::string_view::npos ? at : all.find_first_of("0123456789", at + name.size());
    if (digit == std::string_view::npos) return std::numeric_limits<double>::quiet_NaN();
    double kilobytes = 0;
    std::from_chars(all.data() + digit, all.data() + all.size(), kilobytes);
    return 1024 * kilobytes;
}

}  // namespace grainsweep::workers
