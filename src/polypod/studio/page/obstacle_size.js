// How large obstacles are, and what makes them another size: a hull by its points, others by `size`.

// Extent [x, y, z] along its own axes, and the middle of its box from its position.
export function extentOf({ shape, size, points }) {
  if (shape !== "hull") return { size, middle: [0, 0, 0] };
  const least = [0, 1, 2].map((a) => Math.min(...points.map((point) => point[a])));
  const most = [0, 1, 2].map((a) => Math.max(...points.map((point) => point[a])));
  return {
    size: most.map((value, a) => value - least[a]),
    middle: most.map((value, a) => (value + least[a]) / 2),
  };
}

// Keys of an obstacle of another size, whose middle moves by `shift` along its own axes; `turn`
// turns a vector [x, y, z] of these into the world.
export function resized(obstacle, size, shift, turn) {
  if (obstacle.shape === "hull") {
    const { size: was, middle } = extentOf(obstacle);
    const points = obstacle.points.map((point) => rounded(point.map(
      (value, a) => middle[a] + shift[a] + (value - middle[a]) * (size[a] / was[a]),
    )));
    return { points };
  }
  const moved = turn(shift);
  return { size: rounded(size), position: rounded(obstacle.position.map((value, a) => value + moved[a])) };
}

// The size with one side another: what is round stays round.
export function withSide({ shape }, size, axis, value) {
  if (shape === "sphere") return size.map(() => value);
  if (shape === "cylinder" && axis !== 1) return [value, size[1], value];
  return size.with(axis, value);
}

// To a hundredth of a millimetre: what a hand means, and short in a saved scene.
export function rounded(numbers) {
  return numbers.map((number) => Number(number.toFixed(5)));
}
