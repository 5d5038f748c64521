// Lexer, parser, messages and formatter on any text: spans lie inside the file, and a text that parses keeps its
// meaning when it is formatted, which a second time changes nothing.
#include <cstdint>
#include <cstdlib>

#include "grammar/operations/operations.h"
#include "grammar/syntax/lexer.h"
#include "grammar/syntax/parser.h"
#include "grammar/syntax/printer.h"
#include "tests/syntax/dump.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace sgm::syntax;
    const auto source = std::make_shared<const Source>("a.sgm", std::string(reinterpret_cast<const char*>(data), size));
    Diagnostics diagnostics;
    const Ast ast = parse(source, sgm::operations::table(), diagnostics);
    for (const Diagnostic& d : diagnostics.all())
        if (d.span.source != source.get() || d.span.begin > d.span.end || d.span.end > size || render(d).empty())
            std::abort();
    if (toJson(diagnostics).empty()) std::abort();
    if (diagnostics.hasErrors()) return 0;
    const Dump dump(ast);
    if (!dump.badSpan().empty()) std::abort();
    const auto once = std::make_shared<const Source>("a.sgm", format(*source, sgm::operations::table()));
    Diagnostics again;
    if (Dump(parse(once, sgm::operations::table(), again)).text() != dump.text() || again.hasErrors() ||
        format(*once, sgm::operations::table()) != once->text())
        std::abort();
    return 0;
}
