// What a session keeps of meshes.
#include "tests/document/shown.h"
#include "viewer/document/session.h"

namespace sgm::document {
namespace {

TEST(SessionMeshes, AreForgottenWithTheirDocument) {
    Document document("grammar 2\nstart A -> cube size 2 + sphere size 1 at +y\n");
    Session session;
    ShowRequest request = requestOf(document);
    request.meshResolution = 40;
    session.show(request);
    settle(session);
    const std::weak_ptr<const BuiltMesh> mesh = session.mesh();
    const std::weak_ptr<const BuiltModel> model = session.model();
    ASSERT_FALSE(mesh.expired());
    session.forgetMesh();
    EXPECT_FALSE(session.mesh());
    EXPECT_TRUE(session.model()) << "it stays until there is another";
    document.type("grammar 2\nstart A -> cube size 3 + sphere size 1 at +y\n");
    show(session, document);
    EXPECT_FALSE(session.mesh()) << "nobody asked";
    const Stopwatch watch;  // the worker frees what was let go of
    while (!(mesh.expired() && model.expired()) && watch.seconds() < 60) std::this_thread::yield();
    EXPECT_TRUE(mesh.expired());
    EXPECT_TRUE(model.expired());
    request = requestOf(document);
    request.meshResolution = 40;
    session.show(request);
    settle(session);
    ASSERT_TRUE(session.mesh());
    EXPECT_EQ(session.mesh()->blocksKept, 0u);
}

}  // namespace
}  // namespace sgm::document
