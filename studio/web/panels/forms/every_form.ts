/** The forms of everything that can be edited, which a page loads once something is looked at. */
export { EditForm } from "./edit_forms";
export { SystemForm } from "./system_form";
