/** The forms of everything that can be edited. A page loads them with the first selection. */
export { EditForm } from "./edit_forms";
export { SystemForm } from "./system_form";
