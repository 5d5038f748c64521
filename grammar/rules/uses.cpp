#include "grammar/rules/uses.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "grammar/syntax/parser.h"

namespace sgm::rules {
namespace {

class Gatherer {
public:
    Gatherer(const Loader& load, syntax::Diagnostics& diagnostics) : load_(load), diagnostics_(diagnostics) {}

    void gather(const syntax::Ast& ast) {
        chain_.push_back(ast.source->name());
        for (const syntax::UseDecl& use : ast.uses)
            if (use.file.kind == syntax::Expr::Kind::Text) follow(use, *ast.source);
        chain_.pop_back();
        done_.push_back(ast.source->name());
        files_.asts.push_back(ast);
    }

    Files take() { return std::move(files_); }

private:
    void follow(const syntax::UseDecl& use, const syntax::Source& from) {
        std::string why = "it can't be found";
        const syntax::SourcePtr source = load_.use ? load_.use(use.file.text, from, why) : nullptr;
        if (!source) {
            files_.missing = true;
            diagnostics_.error(use.file.span, fmt::format("can't use \"{}\": {}", use.file.text, why));
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
        if (std::find(done_.begin(), done_.end(), source->name()) == done_.end())
            gather(syntax::parse(source, diagnostics_));
    }

    const Loader& load_;
    syntax::Diagnostics& diagnostics_;
    Files files_;
    std::vector<std::string> chain_;  ///< files being read, the main one first
    std::vector<std::string> done_;
};

}  // namespace

Files withUses(const syntax::Ast& main, const Loader& load, syntax::Diagnostics& diagnostics) {
    Gatherer gatherer(load, diagnostics);
    gatherer.gather(main);
    return gatherer.take();
}

}  // namespace sgm::rules
