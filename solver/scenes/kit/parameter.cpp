#include "solver/scenes/kit/parameter.hpp"

namespace grainsweep::kit {

std::vector<Relevance> relevance(const Conditions& conditions) {
    std::vector<Relevance> all;
    for (const When& when : conditions) {
        if (when.other.empty()) continue;
        Relevance& one = all.emplace_back(Relevance{std::string(when.other), when.condition, {}});
        for (const auto word : when.words)
            if (!word.empty()) one.words.emplace_back(word);
    }
    return all;
}

const Value& value_of(const Inputs& inputs, std::string_view name) {
    const auto found = inputs.find(name);
    if (found == inputs.end()) throw std::logic_error("the inputs hold no " + std::string(name));
    return found->second;
}

ParameterSpec Real::spec() const {
    return {std::string(name), std::string(unit), std::string(meaning), standard, bounds, relevance(only)};
}

ParameterSpec Whole::spec() const {
    return {std::string(name), "1", std::string(meaning), standard, bounds, relevance(only)};
}

const std::string& contents_of(std::string_view name, const Inputs& inputs, const Files& files) {
    const auto given = files.find(name);
    if (given != files.end()) return given->second;
    const auto file = file_word(std::get<std::string>(value_of(inputs, name)));
    throw std::invalid_argument(std::string(name) + ": the contents of " + (file ? std::string(file->path) : "a file") +
                                " are not given");
}

const std::string& FileOr::contents(const Inputs& inputs, const Files& files) const {
    return contents_of(name, inputs, files);
}

ParameterSpec FileOr::spec() const {
    return {std::string(name), "", std::string(meaning), std::string(word), Words{{std::string(word)}, true, check},
            relevance(only)};
}

}  // namespace grainsweep::kit
