-- Starts `tessera lsp` for specifications and the C++ beside them. Neovim 0.7 or newer.
-- Put this file into ~/.config/nvim/plugin/, or load it with :luafile.
local command = vim.g.tessera_command or "tessera"

--- The folder of the next spec.yaml above a file, or nil.
local function project_of(file)
  local folder = vim.fn.fnamemodify(file, ":p:h")
  local found = vim.fn.findfile("spec.yaml", vim.fn.fnameescape(folder) .. ";")
  if found == "" then
    return nil
  end
  return vim.fn.fnamemodify(found, ":p:h")
end

--- Other YAML files are not for this server.
local function is_specification(buffer)
  for _, line in ipairs(vim.api.nvim_buf_get_lines(buffer, 0, 50, false)) do
    if line:match("^tessera:") then
      return true
    end
  end
  return vim.fn.fnamemodify(vim.api.nvim_buf_get_name(buffer), ":t") == "spec.yaml"
end

local clients = {} -- by folder

local function attach(buffer)
  local file = vim.api.nvim_buf_get_name(buffer)
  local code = vim.bo[buffer].filetype == "cpp"
  local folder = project_of(file)
  if (code and not folder) or (not code and not is_specification(buffer)) then
    return
  end
  folder = folder or vim.fn.fnamemodify(file, ":p:h")
  if not clients[folder] then
    clients[folder] = vim.lsp.start_client({
      name = "tessera",
      cmd = { command, "lsp" },
      root_dir = folder,
      on_exit = function()
        clients[folder] = nil
      end,
    })
  end
  if not clients[folder] then
    return
  end
  vim.lsp.buf_attach_client(buffer, clients[folder])
  if not code then
    vim.bo[buffer].omnifunc = "v:lua.vim.lsp.omnifunc" -- Ctrl-X Ctrl-O completes
  end
  local function map(keys, action)
    vim.keymap.set("n", keys, action, { buffer = buffer })
  end
  if not code then
    map("K", vim.lsp.buf.hover)
    map("<leader>a", vim.lsp.buf.code_action)
  end
  map("gd", vim.lsp.buf.definition)
  map("gr", vim.lsp.buf.references)
  map("<leader>r", vim.lsp.buf.rename)
end

vim.api.nvim_create_autocmd("FileType", {
  pattern = { "yaml", "cpp" },
  callback = function(event)
    attach(event.buf)
  end,
})
