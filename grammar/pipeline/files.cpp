#include "grammar/pipeline/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "grammar/syntax/lexer.h"
#include "modeler/core/installation.h"
#include "modeler/core/regular_file.h"
#include "modeler/mesh/distances.h"
#include "modeler/town/own_streets.h"

namespace sgm::pipeline {
namespace fs = std::filesystem;

namespace {

/// The standard library stands beside the installed program or library, or in the tree it was built from.
fs::path standardLibrary() {
    std::error_code ignored;
    for (const fs::path& folder : binaryFolders())
        for (const char* beside : {"../share/sgm/std", "../../share/sgm/std"})
            if (fs::is_directory(folder / beside, ignored)) return fs::weakly_canonical(folder / beside, ignored);
    return SGM_STANDARD_LIBRARY;
}

/// More text than anybody writes; a larger file is something else.
constexpr uint64_t mostGrammar_bytes = 16u << 20;
constexpr const char* outside = "a grammar may only use files in its own folder or in std/";

/// Whether a normal path begins with `name`.
bool beginsWith(const fs::path& path, const char* name) { return !path.empty() && *path.begin() == name; }

bool hasControlCharacter(const std::string& name) {
    return std::any_of(name.begin(), name.end(),
                       [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

/// Where a name that stands in `from` lies, or nothing with `why` set. Every spelling of a file gives the same path,
/// and so does a link within the folder; one that leads out of it is refused like "../".
std::optional<fs::path> pathOf(const std::string& name, const syntax::Source& from, std::string& why) {
    const fs::path wanted = fs::path(name).lexically_normal();
    if (hasControlCharacter(name))
        why = "a file's name holds no control characters";
    else if (wanted.is_absolute() || beginsWith(wanted, ".."))
        why = outside;
    else {
        const bool standard = beginsWith(wanted, "std") && wanted != "std";
        const fs::path folder = standard ? standardLibrary() : fs::path(from.name()).parent_path();
        std::error_code failed;
        const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, failed);
        const fs::path real =
            failed ? fs::path()
                   : fs::weakly_canonical(root / (standard ? wanted.lexically_relative("std") : wanted), failed);
        const fs::path within = real.lexically_relative(root);
        if (failed)
            why = failed.message();
        else if (within.empty() || beginsWith(within, ".."))
            why = outside;
        else
            return folder / within;
    }
    return {};
}

/// Why a file that isn't there can't be read, in the words of the grammar: no path of this machine, and the nearest
/// name.
std::string missingFile(const std::string& name, const fs::path& path) {
    std::vector<std::string> names;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(path.parent_path(), failed))
        if (entry.path().extension() == path.extension()) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    if (fs::exists(standardLibrary() / fs::path(name).lexically_normal(), failed))
        return fmt::format("there is no such file; did you mean \"std/{}\"?", name);
    const std::string near = syntax::didYouMean(path.filename().string(), names);
    const std::string folder = name.substr(0, name.find_last_of('/') + 1);
    return near.empty() ? "there is no such file"
                        : fmt::format("there is no such file; did you mean \"{}{}\"?", folder, near);
}

/// Whether a text begins as a grammar does. What doesn't is never quoted in a message: it may be anything.
bool beginsAsGrammar(const syntax::Source& source) {
    constexpr size_t enough = 1 << 16;  // of comments before the first word
    const syntax::Source head("", std::string(source.text().substr(0, enough)));
    const std::vector<syntax::Token> tokens = syntax::lexSignificant(head);
    return !tokens.empty() && head.text().substr(tokens[0].begin, tokens[0].end - tokens[0].begin) == "grammar";
}

/// The names that the files of the standard library declare, with their files; read when first asked for.
class LibraryNames {
public:
    std::string operator()(const std::string& name) {
        if (!read_) read();
        const auto file = files_.find(name);
        return file == files_.end() ? std::string() : file->second;
    }

private:
    void read() {
        read_ = true;
        for (const auto& [name, source] : standardFiles()) note(*source, name);
    }

    /// `terminal a, b = …` and `rule Name: Symbol …`: the words before what follows names.
    void note(const syntax::Source& source, const std::string& file) {
        const std::vector<syntax::Token> tokens = syntax::lexSignificant(source);
        const auto text = [&](size_t i) {
            return i < tokens.size() ? syntax::textOf(source, tokens[i]) : std::string_view();
        };
        for (size_t i = 0; i < tokens.size(); ++i) {
            if (!tokens[i].columnOne || (text(i) != "terminal" && text(i) != "rule")) continue;
            size_t at = i + 1;
            if (text(i) == "rule" && text(at + 1) == ":") at += 2;
            files_.try_emplace(std::string(text(at)), file);
            for (; text(i) == "terminal" && text(at + 1) == ","; at += 2)
                files_.try_emplace(std::string(text(at + 2)), file);
        }
    }

    bool read_ = false;
    std::map<std::string, std::string> files_;
};

/// Meshes read so far. A text is checked again at every edit, and distances take a good part of a second.
class Meshes {
public:
    explicit Meshes(const Progress* progress) : progress_(progress) {}

    /// The distances to a mesh; `files` gets the other files that they were made from.
    Result<field::SampledGridPtr> operator()(const fs::path& path, std::vector<fs::path>& files) {
        Read& read = known_[path.string()];
        if (read.grid && read.times == timesOf(path, read.files)) {
            files = read.files;
            return read.grid;
        }
        read = {{}, timesOf(path, {}), nullptr};  // of before it is read: a change meanwhile is noticed
        auto grid = mesh::readDistances(path, progress_, &read.files);
        files = read.files;
        if (!grid.ok()) return grid;
        const Times others = timesOf(path, read.files);
        read.times.insert(read.times.end(), others.begin() + 1, others.end());
        read.grid = *grid;
        return grid;
    }

private:
    using Times = std::vector<fs::file_time_type>;
    struct Read {
        std::vector<fs::path> files;
        Times times;
        field::SampledGridPtr grid;
    };

    static Times timesOf(const fs::path& path, const std::vector<fs::path>& files) {
        std::error_code failed;  // a file that is gone has no time that another one has
        Times times{fs::last_write_time(path, failed)};
        for (const fs::path& file : files) times.push_back(fs::last_write_time(file, failed));
        return times;
    }

    const Progress* progress_;
    std::map<std::string, Read> known_;
};

/// Files read so far, each again when its time has changed.
template <class Pointer>
class ReadFiles {
public:
    using Read = std::function<Result<Pointer>(const fs::path& path)>;
    explicit ReadFiles(Read read) : read_(std::move(read)) {}

    Result<Pointer> operator()(const fs::path& path) {
        std::error_code failed;
        const auto time = fs::last_write_time(path, failed);
        Known& known = known_[path.string()];
        if (!failed && known.file && known.time == time) return known.file;
        auto file = read_(path);
        if (file.ok()) known = {time, *file};
        return file;
    }

private:
    struct Known {
        fs::file_time_type time;
        Pointer file;
    };
    Read read_;
    std::map<std::string, Known> known_;
};

template <class T>
Result<std::shared_ptr<const T>> shared(Result<T> made) {
    if (!made.ok()) return made.error();
    return std::make_shared<const T>(std::move(*made));
}

/// Tells a caller of fileLoader(), who may not care, what it was asked for.
class Note {
public:
    explicit Note(FilesRead* read) : read_(read) {}
    void path(const fs::path& path) const {
        if (read_) read_->paths.push_back(path);
    }
    /// Why a file can't be used.
    std::string refusal(const Error& error) const {
        if (read_ && error.kind == Error::Kind::Budget) read_->overBudget = true;
        return error.message;
    }

private:
    FilesRead* read_;
};

/// Reads a file that the grammar may reach, and notes it: what a Loader has for each kind of file.
template <class Read>
auto besideGrammar(Note note, Read read) {
    using Pointer = std::decay_t<decltype(*read(fs::path()))>;
    return [note, files = std::make_shared<ReadFiles<Pointer>>(read)](
               const std::string& name, const syntax::Source& from, std::string& why) -> Pointer {
        const auto path = pathOf(name, from, why);
        if (!path) return nullptr;
        note.path(*path);
        const auto file = (*files)(*path);
        if (file.ok()) return *file;
        why = note.refusal(file.error());
        return nullptr;
    };
}

}  // namespace

Result<syntax::SourcePtr> readSource(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        return Error{Error::Kind::Input, fmt::format("'{}' is a folder, not a grammar file", path.string())};
    Result<std::string> text = readRegularFile(path, mostGrammar_bytes);
    if (!text.ok())
        return Error{text.error().kind, fmt::format("can't read '{}': {}", path.string(), text.error().message)};
    return std::make_shared<const syntax::Source>(path.string(), std::move(*text));
}

std::vector<std::pair<std::string, syntax::SourcePtr>> standardFiles() {
    std::vector<fs::path> paths;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(standardLibrary(), failed))
        if (entry.path().extension() == ".sgm") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::pair<std::string, syntax::SourcePtr>> files;
    for (const fs::path& path : paths)
        if (auto source = readSource(path); source.ok())
            files.emplace_back("std/" + path.filename().string(), std::move(*source));
    return files;
}

rules::Loader fileLoader(const Progress* progress, FilesRead* read) {
    const Note note(read);
    rules::Loader loader(
        [note](const std::string& name, const syntax::Source& from, std::string& why) -> syntax::SourcePtr {
            const auto path = pathOf(name, from, why);
            if (!path) return nullptr;
            note.path(*path);
            std::error_code failed;
            if (!fs::exists(*path, failed) && !failed) return why = missingFile(name, *path), nullptr;
            Result<syntax::SourcePtr> source = readSource(*path);
            if (source.ok() && beginsAsGrammar(**source)) return *source;
            why = source.ok() ? "it is no grammar: one begins with 'grammar 1'" : note.refusal(source.error());
            return nullptr;
        });
    loader.mesh = [note, meshes = std::make_shared<Meshes>(progress)](
                      const std::string& name, const syntax::Source& from, std::string& why) -> field::SampledGridPtr {
        const auto path = pathOf(name, from, why);
        if (!path) return nullptr;
        note.path(*path);
        std::vector<fs::path> files;
        const auto grid = (*meshes)(*path, files);
        for (const fs::path& file : files) note.path(file);
        if (grid.ok()) return *grid;
        why = note.refusal(grid.error());
        return nullptr;
    };
    loader.outlines = besideGrammar(
        note, [progress](const fs::path& path) { return shared(plan::readOutlines(path, {}, progress)); });
    loader.picture =
        besideGrammar(note, [progress](const fs::path& path) { return town::readRaster(path, {}, progress); });
    loader.image =
        besideGrammar(note, [progress](const fs::path& path) { return image::readImageFile(path, {}, progress); });
    loader.streets =
        besideGrammar(note, [progress](const fs::path& path) { return shared(town::readStreets(path, progress)); });
    loader.declares = [names = std::make_shared<LibraryNames>()](const std::string& name) { return (*names)(name); };
    return loader;
}

}  // namespace sgm::pipeline
