// { name = value … }: of declarations and operations.
#include <utility>

#include "grammar/syntax/bodies.h"
#include "grammar/syntax/expressions.h"

namespace sgm::syntax {

std::string missingEqualsHint(const Cursor& cursor, const Name& name) {
    const size_t value = cursor.at(":") ? 1 : 0;  // what stands behind the wrong sign
    return cursor.peekText(value).empty() ? std::string()
                                          : "write " + quoted(name.text + " = " + std::string(cursor.peekText(value)));
}

std::vector<Setting> readSettings(Cursor& cursor) {
    std::vector<Setting> settings;
    const Token open = cursor.peek();
    if (!cursor.expect("{", "before the settings")) return settings;
    while (!cursor.done() && !cursor.at("}")) {
        Setting setting;
        setting.name = readName(cursor, "a parameter");
        cursor.expect("=", "after the parameter's name", missingEqualsHint(cursor, setting.name));
        setting.value = readExpr(cursor);
        setting.span = join(setting.name.span, setting.value.span);
        settings.push_back(std::move(setting));
        if (cursor.at(",")) cursor.complain(cursor.span(cursor.take()), "settings stand side by side", "leave ',' out");
    }
    cursor.close(open);
    return settings;
}

}  // namespace sgm::syntax
