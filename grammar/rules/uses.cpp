#include "grammar/rules/uses.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "grammar/syntax/parser.h"
#include "modeler/core/printable.h"

namespace sgm::rules {
namespace {

constexpr size_t mostOpen = 100;              ///< files that wait for those they use
constexpr size_t mostText_bytes = 64u << 20;  ///< of all files together
constexpr size_t shownName_bytes = 200;

class Gatherer {
public:
    Gatherer(const Loader& load, syntax::Diagnostics& diagnostics) : load_(load), diagnostics_(diagnostics) {}

    void gather(const syntax::Ast& ast) {
        operations_ = ast.operations;
        chain_.push_back(ast.source->name());
        text_bytes_ += ast.source->text().size();
        for (const syntax::UseDecl& use : ast.uses)
            if (use.file.kind == syntax::Expr::Kind::Text) follow(use, *ast.source);
        chain_.pop_back();
        done_.insert(ast.source->name());
        files_.asts.push_back(ast);
    }

    Files take() { return std::move(files_); }

private:
    void follow(const syntax::UseDecl& use, const syntax::Source& from) {
        std::string why = "it can't be found";
        const syntax::SourcePtr source = load_.use ? load_.use(use.file.text, from, why) : nullptr;
        if (!source) {
            refuse(use, fmt::format("can't use \"{}\": {}", shortened(use.file.text, shownName_bytes), why));
            return;
        }
        const auto open = std::find(chain_.begin(), chain_.end(), source->name());
        if (open != chain_.end()) {
            diagnostics_.error(use.file.span,
                               fmt::format("files use each other in a circle: {} -> {}",
                                           fmt::join(open, chain_.end(), " -> "), source->name()),
                               "leave one 'use' out");
            return;
        }
        if (done_.contains(source->name())) return;
        if (chain_.size() >= mostOpen)
            refuse(use, fmt::format("more than {} files use each other in a row", mostOpen),
                   "let the main file use them");
        else if (text_bytes_ + source->text().size() > mostText_bytes)
            refuse(use, fmt::format("the files used so far hold more than {} MiB", mostText_bytes >> 20));
        else
            gather(syntax::parse(source, *operations_, diagnostics_));
    }

    /// A file that isn't there for the checker.
    void refuse(const syntax::UseDecl& use, std::string message, std::string hint = {}) {
        files_.missing = true;
        diagnostics_.error(use.file.span, std::move(message), std::move(hint));
    }

    const Loader& load_;
    syntax::Diagnostics& diagnostics_;
    Files files_;
    std::vector<std::string> chain_;  ///< files being read, the main one first
    std::set<std::string> done_;
    const syntax::OperationTable* operations_ = nullptr;
    size_t text_bytes_ = 0;
};

}  // namespace

Files withUses(const syntax::Ast& main, const Loader& load, syntax::Diagnostics& diagnostics) {
    Gatherer gatherer(load, diagnostics);
    gatherer.gather(main);
    return gatherer.take();
}

}  // namespace sgm::rules
