// Pictures are drawn when the screen wants one.

/**
 * A function that asks for a picture. Many calls before the next picture of the screen give one.
 * @param {(time: number) => void} draw gets the time of the screen, milliseconds
 */
export function oncePerFrame(draw) {
  let isAsked = false;
  return () => {
    if (!isAsked) {
      isAsked = true;
      requestAnimationFrame((time) => {
        isAsked = false;
        draw(time);
      });
    }
  };
}
