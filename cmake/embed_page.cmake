# The page as a C++ source: cmake -DPAGE=report.html -DSOURCE=page_template.cpp -P embed_page.cmake
set(text "")
if(PAGE)
  file(READ ${PAGE} text)
endif()
file(WRITE ${SOURCE} "#include \"tendril/report/page_template.hpp\"

namespace tendril::report {

std::string_view page_template() {
  static constexpr char text[] = R\"tendril_page(")
file(APPEND ${SOURCE} "${text}")
file(APPEND ${SOURCE} ")tendril_page\";
  return {text, sizeof text - 1};
}

}  // namespace tendril::report
")
