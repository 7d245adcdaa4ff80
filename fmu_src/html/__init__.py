"""The one writer of HTML: pages that need no other file, of results, of comparisons and in FMUs.

    markup  pieces: text, tables, notes, equations, figures, sections
    page    a page around its sections: head, style, navigation, script

`page.html` and `style.css` are what every page has.
"""
