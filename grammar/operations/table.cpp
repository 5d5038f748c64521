#include "grammar/operations/operations.h"

namespace sgm::operations {

const syntax::OperationTable& table() {
#define SGM_ROW(name) &name,
    static constexpr const syntax::Operation* rows[] = {SGM_OPERATIONS(SGM_ROW)};
#undef SGM_ROW
    static constexpr syntax::OperationTable all(rows);
    return all;
}

}  // namespace sgm::operations
