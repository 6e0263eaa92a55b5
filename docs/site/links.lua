-- Links between Markdown pages become links between the site's; those to files of the source tree, plain text.
function Link(link)
  local target = link.target
  if target:match("^%a+://") or target:match("^#") then return link end
  local page, anchor = target:match("([%w_]+)%.md(#?[%w_-]*)$")
  if not page then return link.content end
  link.target = (page == "README" and "index" or page:lower()) .. ".html" .. anchor
  return link
end

function Image(image)
  image.src = image.src:gsub("^docs/", "")
  return image
end
