// The text of a spool's files.
#include "sweep/spool/spool.hpp"

#include "sweep/workers/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace grainsweep::spool {
namespace {

constexpr std::string_view answer_head = "grainsweep answer 1\n", claim_head = "grainsweep claim 1\n",
                           checksum_word = "checksum ";
constexpr std::size_t hash_digits = 32, most_attempt_digits = 9;

/// Up to the next line's end, which must be there; both are taken off.
std::optional<std::string_view> take_line(std::string_view& text) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const auto line = text.substr(0, end);
    text.remove_prefix(end + 1);
    return line;
}

Entry answer_in(std::string_view text) {
    const std::size_t tail = checksum_word.size() + hash_digits + 1;
    if (text.size() < answer_head.size() + tail) return Damaged{"it ends too early"};
    const auto body = text.substr(0, text.size() - tail);
    const auto end = text.substr(body.size());
    if (!end.starts_with(checksum_word) || end.back() != '\n') return Damaged{"it ends too early"};
    if (end.substr(checksum_word.size(), hash_digits) != campaign::content_hash(body))
        return Damaged{"its checksum is another"};
    auto rest = body.substr(answer_head.size());
    const auto ready_line = take_line(rest);
    const auto done_line = take_line(rest);
    if (!ready_line || !done_line || !rest.empty()) return Damaged{"it has other lines than an answer"};
    try {
        auto ready = workers::decode_to_boss(*ready_line);
        auto done = workers::decode_to_boss(*done_line);
        auto* const by = std::get_if<workers::Ready>(&ready);
        auto* const result = std::get_if<workers::Done>(&done);
        if (by == nullptr || result == nullptr) return Damaged{"it has other lines than an answer"};
        return Answer{std::move(result->result), std::move(by->computer)};
    } catch (const std::invalid_argument& error) {
        return Damaged{error.what()};
    }
}

}  // namespace

std::string text_of(const Answer& answer) {
    std::string text(answer_head);
    text += workers::encode(workers::ToBoss(workers::Ready{workers::protocol_number, answer.computer})) + "\n";
    text += workers::encode(workers::ToBoss(workers::Done{answer.result, false})) + "\n";
    return text + fmt::format("{}{}\n", checksum_word, campaign::content_hash(text));
}

std::string text_of(const Claim& claim) {
    return fmt::format("{}{}\n", claim_head, claim.task);
}

Entry entry_in(std::string_view text) {
    if (text.empty()) return Claim{};
    if (text.starts_with(claim_head)) {
        text.remove_prefix(claim_head.size());
        const auto task = take_line(text);
        return Claim{task ? std::string(*task) : std::string()};
    }
    if (claim_head.starts_with(text)) return Claim{};
    if (text.starts_with(answer_head)) return answer_in(text);
    return Damaged{"it does not begin as an answer of this program does"};
}

std::optional<campaign::Attempt> attempt_named(std::string_view file) {
    const auto dot = file.find('.');
    if (dot != hash_digits) return std::nullopt;
    const auto id = file.substr(0, dot);
    const auto digits = file.substr(dot + 1);
    const auto hexadecimal = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (!std::ranges::all_of(id, hexadecimal) || digits.empty() || digits.size() > most_attempt_digits ||
        error != std::errc() || end != digits.data() + digits.size() || number < 1 || digits.front() == '0')
        return std::nullopt;
    return campaign::Attempt{campaign::CaseId(id), number};
}

std::string hash_of_cases(const campaign::Cases& cases) {
    std::string all;
    all.reserve(cases.size() * (hash_digits + 1));
    for (std::size_t i = 0; i < cases.size(); ++i) all += cases.id(i) + "\n";
    return campaign::content_hash(all);
}

}  // namespace grainsweep::spool
