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

TEST(SessionMeshes, AreFinishedWhenTheyAreAskedForAgain) {
    const Document document(
        "grammar 2\nstart A -> cube size (20, 1, 20) for k in 1..60 { + cube size (.05m, 2m, 20m) at +y "
        "move (.3m * k - 9m, 0, 0) }\n");
    const auto ask = [&](Session& session, int resolution) {
        ShowRequest request = requestOf(document);
        request.meshResolution = resolution;
        session.show(request);
    };
    Session undisturbed, left;
    ask(undisturbed, 48);
    settle(undisturbed);
    ASSERT_TRUE(undisturbed.mesh());
    ask(left, 48);
    while (!left.mesh()) left.poll();
    ask(left, 0);  // the window shows the field while cells are halved around the slats
    settle(left);
    ask(left, 48);
    settle(left);
    EXPECT_EQ(left.mesh()->mesh->triangleCount(), undisturbed.mesh()->mesh->triangleCount());
    EXPECT_EQ(left.problems(), undisturbed.problems());
}

}  // namespace
}  // namespace sgm::document
