// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/serve/serve.hpp>

namespace thalweg::studio {

/// Options of a Studio.
struct StudioParams {
    std::string folder;             ///< of a document, which new_document() made
    std::string export_folder = {}; ///< below which everything that make writes is put on demand; "": the document's
    int threads = 0;                ///< as Run
    serve::ServeParams serve = {};
};

/// The document that a user means.
/// \param input the folder of a document; or what new_document() begins with; "": the folder, or ./studio, where it is
/// a document, else recipe::default_recipe()
/// \param folder where a new document begins; "": ./studio, ./studio-2, … whichever is free
/// \param is_blank a new document is an empty sheet, and no input is given
/// \param preset a new document has it, as for new_document(); "": none
/// \return the folder of a document, which is there now
/// \throws Error as new_document()
std::string document_for(std::string const& input, std::string const& folder, bool is_blank = false,
                         std::string const& preset = {}, Run const& run = {});

class StudioSession;

/// A document that browsers on this machine look at and edit. Every edit is saved before it is answered, and its
/// terrain follows, coarse first. Several windows may edit one document. The page and its messages: web/README.md.
class Studio {
public:
    /// \throws Error as DocumentFolder and serve::Server
    explicit Studio(StudioParams params);
    ~Studio();
    Studio(Studio const&) = delete;
    Studio& operator=(Studio const&) = delete;

    /// \return the address of the page, with its token
    std::string address() const;
    /// Serves until a stop is requested, then ends within two seconds, with everything saved. May be called once.
    void run(std::stop_token const& stop);

private:
    std::unique_ptr<StudioSession> desk_;
};

} // namespace thalweg::studio
