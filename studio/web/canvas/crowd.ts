/** Of a sheet with more nodes, only those in the window and around it are drawn, unless they are dots. */
export const crowd = 600;
