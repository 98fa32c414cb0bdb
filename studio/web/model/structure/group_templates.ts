import type { YamlText } from "../text/yaml_text";

/** The templates of groups. */
export const groupTemplates = (yaml: YamlText): string[] =>
  yaml.keys(["templates"]).filter((name) => isGroupTemplate(yaml, name));
export const isGroupTemplate = (yaml: YamlText, name: string): boolean =>
  yaml.pair(["templates", name, "behaviours"]) !== undefined && yaml.pair(["templates", name, "control"]) === undefined;
/** The names that a template of a group takes. */
export const takenBy = (yaml: YamlText, template: string): string[] => {
  const names = yaml.data(["templates", template, "with"]);
  return Array.isArray(names) ? names.map(String) : [];
};
