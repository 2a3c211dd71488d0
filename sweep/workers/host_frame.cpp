#include "sweep/workers/host_frame.hpp"

#include <boost/crc.hpp>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <optional>

namespace grainsweep::workers::frames {
namespace {

constexpr std::string_view hello_word = "grainsweep host ";
// A launcher may greet; one that floods is no launcher.
constexpr std::size_t most_greeting_bytes = std::size_t{64} << 10U;
constexpr std::size_t longest_head = 100;  // four numbers and a word

/// The CRC that cksum(1) prints: of the bytes, then of their number, least significant byte first.
class Sum {
public:
    Sum& add(std::string_view bytes) {
        crc_.process_bytes(bytes.data(), bytes.size());
        count_ += bytes.size();
        return *this;
    }
    [[nodiscard]] std::uint32_t value() {
        for (std::size_t rest = count_; rest > 0; rest >>= 8U) crc_.process_byte(static_cast<unsigned char>(rest));
        return crc_.checksum();
    }

private:
    boost::crc_optimal<32, 0x04C11DB7, 0, 0xFFFFFFFF, false, false> crc_;
    std::size_t count_ = 0;
};

/// A body, even an empty one, is followed by a line's end.
void add_frame(std::string& to, std::string_view word, std::initializer_list<std::uint64_t> numbers,
               std::optional<std::string_view> body = {}) {
    std::string head(word);
    for (const auto number : numbers) head += (head.empty() ? "" : " ") + std::to_string(number);
    const auto sum = Sum().add(head).add("\n").add(body.value_or("")).value();
    to += head + ' ' + std::to_string(sum) + '\n';
    if (body) to.append(*body) += '\n';
}

/// Numbers and words of a line, taken one by one.
class Words {
public:
    explicit Words(std::string_view line) : rest_(line) {}
    [[nodiscard]] std::string_view word() {
        const auto end = std::min(rest_.find(' '), rest_.size());
        const auto taken = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        return taken;
    }
    template <class Whole>
    [[nodiscard]] Whole number() {
        const auto taken = word();
        Whole value{};
        const auto [end, error] = std::from_chars(taken.data(), taken.data() + taken.size(), value);
        if (taken.empty() || error != std::errc() || end != taken.data() + taken.size()) sound_ = false;
        return value;
    }
    /// Whether all that was taken was there, and nothing is left.
    [[nodiscard]] bool over() const { return sound_ && rest_.empty(); }

private:
    std::string_view rest_;
    bool sound_ = true;
};

struct Head {
    Frame frame;
    std::optional<std::size_t> body = {};   ///< bytes that follow the line, without their end
    std::optional<std::uint32_t> sum = {};  ///< of what stands before it, a line's end and the body
};

/// Without the sum.
std::optional<Head> plain_head_of(std::string_view line) {
    Words words(line);
    Head head;
    if (!line.empty() && line.front() >= '0' && line.front() <= '9') {
        head.frame = Piece{words.number<WorkerNumber>(), {}};
        head.body = words.number<std::size_t>();
    } else if (line.starts_with(hello_word)) {
        words = Words(line.substr(hello_word.size()));
        head.frame = Hello{words.number<std::int64_t>()};
    } else {
        const auto word = words.word();
        if (word == "alive" || word == "lease") {
            head.frame = Beat{};
        } else if (word == "start") {
            head.frame = Start{words.number<WorkerNumber>()};
        } else if (word == "close") {
            head.frame = Close{words.number<WorkerNumber>()};
        } else if (word == "signal") {
            const auto worker = words.number<WorkerNumber>();
            head.frame = Signal{worker, words.number<int>()};
        } else if (word == "ended") {
            const auto worker = words.number<WorkerNumber>();
            const int status = words.number<int>();
            head.frame = Ended{worker, status, {}};
            head.body = words.number<std::size_t>();
        } else {
            return std::nullopt;
        }
    }
    if (!words.over() || head.body.value_or(0) > longest_piece) return std::nullopt;
    return head;
}

std::optional<Head> head_of(std::string_view line) {
    if (line.starts_with(hello_word) || std::string_view(lease_frame).starts_with(line) ||
        std::string_view(alive_frame).starts_with(line))
        return plain_head_of(line);
    const auto last = line.rfind(' ');
    if (last == std::string_view::npos) return std::nullopt;
    auto head = plain_head_of(line.substr(0, last));
    Words words(line.substr(last + 1));
    const auto sum = words.number<std::uint32_t>();
    if (!head || !words.over()) return std::nullopt;
    head->sum = sum;
    return head;
}

/// Whether a frame is as it was written. `line`: its head with the sum.
bool is_unchanged(const Head& head, std::string_view line, std::string_view body) {
    return !head.sum || *head.sum == Sum().add(line.substr(0, line.rfind(' '))).add("\n").add(body).value();
}

}  // namespace

void add_hello(std::string& to) {
    to += hello_word;
    to += std::to_string(host_protocol) + "\n";
}

void add_start(std::string& to, WorkerNumber worker) {
    add_frame(to, "start", {worker});
}

void add_piece(std::string& to, WorkerNumber worker, std::string_view bytes) {
    for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), longest_piece))) {
        const auto part = bytes.substr(0, longest_piece);
        add_frame(to, "", {worker, part.size()}, part);
    }
}

void add_signal(std::string& to, WorkerNumber worker, int number) {
    add_frame(to, "signal", {worker, static_cast<std::uint64_t>(number)});
}

void add_close(std::string& to, WorkerNumber worker) {
    add_frame(to, "close", {worker});
}

void add_ended(std::string& to, WorkerNumber worker, int status, std::string_view log) {
    log = log.substr(log.size() - std::min(log.size(), longest_piece));
    add_frame(to, "ended", {worker, static_cast<std::uint64_t>(status), log.size()}, log);
}

std::size_t Reader::parse(std::string_view text, Frame& frame) {
    const std::size_t end = text.find('\n');
    if (!greeted_) {
        const auto line = text.substr(0, end);
        if (greeting_bytes_ + line.size() > most_greeting_bytes) return nonsense;
        if (end == std::string_view::npos) return 0;
        // Only a host's first words are no greeting.
        const auto head = line.starts_with(hello_word) ? head_of(line) : std::nullopt;
        if (head) {
            greeted_ = true;
            frame = head->frame;
        } else {
            greeting_bytes_ += line.size() + 1;
            frame = Greeting{line};
        }
        return end + 1;
    }
    if (end > longest_head) return text.size() > longest_head ? nonsense : 0;
    const auto line = text.substr(0, end);
    const auto head = head_of(line);
    if (!head) return nonsense;
    frame = head->frame;
    if (!head->body) return is_unchanged(*head, line, {}) ? end + 1 : nonsense;
    const std::size_t whole = end + 1 + *head->body + 1;
    if (text.size() < whole) return 0;
    if (text[whole - 1] != '\n') return nonsense;
    const auto body = text.substr(end + 1, *head->body);
    if (!is_unchanged(*head, line, body)) return nonsense;
    if (auto* piece = std::get_if<Piece>(&frame)) piece->bytes = body;
    if (auto* ended = std::get_if<Ended>(&frame)) ended->log = body;
    return whole;
}

}  // namespace grainsweep::workers::frames
