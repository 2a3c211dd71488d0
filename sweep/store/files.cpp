// Files of campaigns in the archive: who used them, their contents.
#include "sweep/campaign/file_contents.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <vector>

namespace grainsweep::store {
namespace {

constexpr std::string_view table_of_files = "campaign_file";

std::uint64_t sum_of_stored_file(std::int64_t campaign, std::string_view place, std::string_view name,
                                 std::string_view hash) {
    return Digest().add(campaign).add(place).add(name).add(hash).value();
}

std::optional<std::string> stored_contents(const Connection& db, std::string_view hash) {
    if (!has_programs(db)) return std::nullopt;
    auto rows = db.ask("SELECT contents FROM program_content WHERE hash = ?", hash);
    return rows.next() ? std::optional<std::string>(rows.blob(0)) : std::nullopt;
}

}  // namespace

void store_files(Connection& db, std::int64_t campaign_key, const campaign::Campaign& campaign) {
    for (const auto& file : campaign.files) {
        if (!db.value<std::int64_t>("SELECT 1 FROM program_content WHERE hash = ?", file.hash)) {
            const auto path = file.path.empty() ? file.name : file.path.string();
            auto read = campaign::contents_of(FileWord{file.hash, path});
            if (const auto* why = std::get_if<std::string>(&read))
                throw campaign::input_error(file.place, file.name, *why);
            db.run("INSERT INTO program_content (hash, contents) VALUES (?, ?) ON CONFLICT DO NOTHING", file.hash,
                   Blob{std::get<campaign::FileContents>(read).text});
        }
        db.run(
            "INSERT INTO campaign_file (campaign_id, place, name, hash, checksum) VALUES (?, ?, ?, ?, ?) ON CONFLICT "
            "DO "
            "UPDATE SET name = excluded.name, checksum = excluded.checksum",
            campaign_key, file.place, file.name, file.hash,
            as_sql(sum_of_stored_file(campaign_key, file.place, file.name, file.hash)));
    }
}

std::vector<StoredFile> Store::files_of(std::string_view id) const {
    const auto& db = impl_->db;
    std::vector<StoredFile> files;
    if (!has_table(db, table_of_files)) return files;
    auto rows = db.ask(
        "SELECT DISTINCT f.place, f.name, f.hash, (SELECT length(contents) FROM program_content AS c WHERE c.hash = "
        "f.hash) FROM sim_case AS s JOIN campaign_case AS p ON p.case_key = s.case_key JOIN campaign_file AS f ON "
        "f.campaign_id = p.campaign_id WHERE s.case_id = ? ORDER BY f.place, f.name, f.hash",
        id);
    while (rows.next())
        files.push_back({rows.get<std::string>(0), rows.get<std::string>(1), rows.get<std::string>(2),
                         rows.get<std::optional<std::int64_t>>(3)});
    return files;
}

void Store::enter_files_of(const campaign::Case& question) const {
    for (const auto& [name, value] : question.inputs) {
        const auto* word = std::get_if<std::string>(&value);
        const auto file = word == nullptr ? std::nullopt : file_word(*word);
        auto contents = file ? stored_contents(impl_->db, file->hash) : std::nullopt;
        if (!contents) continue;  // an archive older than the storage of files: the file at the path is read
        if (campaign::content_hash(*contents) != file->hash)
            throw SystemError(fmt::format("database '{}': damaged: the contents of '{}' are not as written",
                                          impl_->file.string(), file->path));
        campaign::enter_contents(std::move(*contents));
    }
}

std::vector<std::string> damaged_files(const Connection& db) {
    std::vector<std::string> damaged;
    if (!has_table(db, table_of_files)) return damaged;
    auto rows = db.ask(
        "SELECT f.campaign_id, f.place, f.name, f.hash, f.checksum, c.hash IS NULL FROM campaign_file AS f NOT INDEXED "
        "LEFT JOIN program_content AS c ON c.hash = f.hash");
    while (rows.next()) {
        const auto campaign = rows.get<std::int64_t>(0);
        const auto place = rows.get<std::string>(1), name = rows.get<std::string>(2), hash = rows.get<std::string>(3);
        if (as_sql(sum_of_stored_file(campaign, place, name, hash)) != rows.get<std::int64_t>(4))
            damaged.push_back(fmt::format("table campaign_file: {} of campaign {} is not as written", place, campaign));
        if (rows.get<std::int64_t>(5) != 0)
            damaged.push_back(fmt::format("table program_content: {}, file '{}', is missing", hash, name));
    }
    return damaged;
}

}  // namespace grainsweep::store
