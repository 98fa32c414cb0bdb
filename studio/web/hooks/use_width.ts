import { useLayoutEffect, useRef, useState, type RefObject } from "react";

/** The width of an element in pixels, also after the window has changed; 0: it is not on the page yet. */
export function useWidth<Shown extends Element>(): [RefObject<Shown | null>, number] {
  const ref = useRef<Shown>(null);
  const [width, setWidth] = useState(0);
  useLayoutEffect(() => {
    const element = ref.current;
    if (!element) return;
    const look = () => setWidth(Math.floor(element.clientWidth));
    look();
    const observer = new ResizeObserver(look);
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  return [ref, width];
}
