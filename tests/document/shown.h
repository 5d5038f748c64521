// A document with its model, for tests of what is shown of it.
#pragma once

#include <thread>

#include "tests/document/texts.h"
#include "viewer/document/session.h"

namespace sgm::document {

/// Polls until the session has nothing left to do.
inline void settle(Session& session) {
    while (session.busy()) {
        session.poll();
        std::this_thread::yield();
    }
    session.poll();
}

/// Shows the document as it stands and waits for it.
inline void show(Session& session, const Document& document) {
    session.show(requestOf(document));
    settle(session);
}

/// A model of the text, without problems.
inline std::shared_ptr<const BuiltModel> shown(const Document& document) {
    Session session;
    show(session, document);
    for (const Problem& p : session.problems())
        if (p.severity == syntax::Severity::Error) ADD_FAILURE() << p.line << ": " << p.message;
    return session.model();
}

}  // namespace sgm::document
