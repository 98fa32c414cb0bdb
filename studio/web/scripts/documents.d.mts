export function writeDocuments(to: string): void;
