"""Sphinx settings of the site that `make docs` builds; tools/make_docs.py prepares its source from the repository."""

project = "Tendril"
copyright = "the Tendril authors"  # noqa: A001, the name that Sphinx reads
html_title = "Tendril"
html_theme = "furo"
html_copy_source = False
html_show_sphinx = False
html_static_path = ["_static"]
html_css_files = ["site.css"]

extensions = ["myst_parser", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown"}
root_doc = "index"
myst_heading_anchors = 3
myst_links_external_new_tab = True

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_type_aliases = {"ArrayLike": "ArrayLike"}
default_role = "code"  # docstrings write `names` as Markdown does


def setup(app):
    def plain(app, what, name, obj, options, signature, returns):
        return signature and signature.replace("TypeAliasForwardRef('ArrayLike')", "ArrayLike"), returns

    app.connect("autodoc-process-signature", plain)
