// The session: what is recomputed, what is kept when a text is broken.
#include "viewer/document/session.h"

#include "tests/document/texts.h"

namespace sgm::viewer {
namespace {

/// Polls until the session has nothing to do.
void settle(Session& session) {
    while (session.busy()) {
        session.poll();
        std::this_thread::yield();
    }
    session.poll();
}

TEST(Sessions, ShowAModel) {
    Session session;
    Document document("grammar 1\nparam a = 2 in 1..9\nstart A -> cube size a\n");
    session.show(requestOf(document));
    settle(session);
    ASSERT_TRUE(session.model());
    EXPECT_TRUE(session.problems().empty());
}

}  // namespace
}  // namespace sgm::viewer
