// verify: reads a whole archive and names all data that changed after they were written.
#include "sweep/cli/command.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"
#include "sweep/store/store.hpp"

#include <fmt/format.h>

#include <iostream>
#include <string>

namespace grainsweep::cli {
namespace {

using report::Format;
using store::Store;
using store::Table;

std::string contents_of(const Store& archive) {
    const auto count = [&](const char* table) {
        return std::get<std::int64_t>(archive.query(fmt::format("SELECT count(*) FROM {}", table)).rows.at(0).at(0));
    };
    std::int64_t imported = 0;
    const auto status = archive.status();
    for (const auto& row : status.rows) imported += std::get<std::int64_t>(row.back());
    return fmt::format("{} cases{}, {} attempts, {} measured values", count("sim_case"),
                       imported > 0 ? fmt::format(" ({} of them computed elsewhere)", imported) : "", count("attempt"),
                       count("observation"));
}

std::string sound(const Store& archive) {
    if (!archive.has_checksums())
        return fmt::format(
            "no damage was found: pages, indices and references agree. {} were written before "
            "there were checksums; the next run adds them",
            contents_of(archive));
    return fmt::format("nothing is damaged: {}; pages, indices, references, checksums and ids agree",
                       contents_of(archive));
}

int verify(const std::string& database, Format format) {
    const Store archive(database, Store::Mode::read);
    const auto damages = archive.verify();
    Table table{report::columns_of(report::results::damage), {}};
    for (const auto& damage : damages)
        table.rows.push_back({damage.kind, damage.case_id, damage.campaign, damage.observable, damage.what});
    if (format != Format::text || !damages.empty()) report::write(std::cout, table, format);
    if (format == Format::text && damages.empty()) std::cout << sound(archive) << '\n';
    return damages.empty() ? 0 : 1;
}

}  // namespace

std::vector<Command> verify_commands() {
    return {command<std::string>(
        "verify", "checks the whole database and names damaged entries",
        [](Parser& parser, std::string& database) { parser.add_option("DB", database, "database"); }, verify)};
}

}  // namespace grainsweep::cli
