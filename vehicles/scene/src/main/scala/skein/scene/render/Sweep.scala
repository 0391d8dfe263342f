package skein.scene.render

import java.util.Arrays

/** Decides which face is visible at each pixel. Row by row, it passes the edges of faces from left to right;
  * the nearest open face is visible until it ends, another begins, or one behind intersects it. So the cost
  * depends on the number of edges, not of pixels, and visibility is exact whatever the order of the faces.
  */
final private[render] class Sweep(view: View, surfaces: Surfaces):
  import surfaces.{bottom, first, spans, top}

  private val rowsFirst = new Array[Int](view.height)       // the first face that begins in a row, plus 1
  private val another   = new Array[Int](surfaces.count)
  private var active    = new Array[Int](64)                // by their left ends
  private var actives   = 0
  private val left      = new Array[Int](surfaces.count)
  private val right     = new Array[Int](surfaces.count)
  private val inverse   = new Array[Double](surfaces.count) // depth's, at the middle of the row's pixel 0
  private var open      = new Array[Int](64)
  private var opened    = 0

  /** Reports to every layer the visible face of every pixel, exactly once. */
  def run(layers: Array[Layer]): Unit =
    var face = surfaces.count - 1
    while face >= 0 do
      another(face) = rowsFirst(top(face))
      rowsFirst(top(face)) = face + 1
      face -= 1
    var row = 0
    while row < view.height do
      advanceTo(row)
      pass(row, layers)
      row += 1

  /** Updates the faces that cover this row, and their extents. */
  private def advanceTo(row: Int): Unit =
    var kept = 0
    var i    = 0
    while i < actives do
      val face = active(i)
      if bottom(face) > row then
        active(kept) = face
        kept += 1
      i += 1
    actives = kept
    var begins = rowsFirst(row)
    while begins > 0 do
      if actives == active.length then active = Arrays.copyOf(active, 2 * actives)
      active(actives) = begins - 1
      actives += 1
      begins = another(begins - 1)
    i = 0
    while i < actives do
      val face = active(i)
      val at   = first(face) + 2 * (row - top(face))
      left(face) = spans(at)
      right(face) = spans(at + 1)
      inverse(face) = surfaces.c(face) + surfaces.b(face) * (row + 0.5) + surfaces.a(face) * 0.5
      // The order of the previous row is nearly that of this row.
      var j = i
      while j > 0 && left(active(j - 1)) > left(face) do
        active(j) = active(j - 1)
        j -= 1
      active(j) = face
      i += 1

  private def pass(row: Int, layers: Array[Layer]): Unit =
    var x     = 0
    var next  = 0
    var seen  = Layer.Sky
    var since = 0
    opened = 0
    while x < view.width do
      while next < actives && left(active(next)) <= x do
        if right(active(next)) > x then
          if opened == open.length then open = Arrays.copyOf(open, 2 * opened)
          open(opened) = active(next)
          opened += 1
        next += 1
      val nearest = nearestAt(x)
      val begins  = if next < actives then left(active(next)) else view.width
      val end     = math.min(begins, if nearest == Layer.Sky then view.width else right(nearest))
      val until   = if nearest == Layer.Sky || opened == 1 then end else hiddenFrom(nearest, x, end)
      if nearest != seen then
        tell(layers, seen, row, since, x)
        seen = nearest
        since = x
      x = until
    tell(layers, seen, row, since, x)

  private def tell(layers: Array[Layer], face: Int, row: Int, from: Int, until: Int): Unit =
    if from < until then
      var i = 0
      while i < layers.length do
        layers(i).fill(face, row, from, until)
        i += 1

  private def inverseAt(face: Int, x: Int): Double = inverse(face) + surfaces.a(face) * x

  /** The visible open face at this pixel; among equally near faces, the one added first. Closes faces that
    * have ended.
    */
  private def nearestAt(x: Int): Int =
    var best   = Layer.Sky
    var bestAt = 0.0
    var i      = 0
    while i < opened do
      val face = open(i)
      if right(face) <= x then
        opened -= 1
        open(i) = open(opened)
      else
        val at = inverseAt(face, x)
        if at > bestAt || (at == bestAt && face < best) then
          best = face
          bestAt = at
        i += 1
    best

  /** The first pixel before `end` where another open face comes in front of this one, or `end`. */
  private def hiddenFrom(face: Int, x: Int, end: Int): Int =
    var until = end
    var i     = 0
    while i < opened do
      val other = open(i)
      if other != face then
        val last = math.min(until, right(other)) - 1
        if last > x && inverseAt(other, last) > inverseAt(face, last) then
          val gap   = inverseAt(face, x) - inverseAt(other, x)
          val meets = x + (gap / (surfaces.a(other) - surfaces.a(face))).toInt
          var at    = math.max(x + 1, math.min(last, meets))
          while at > x + 1 && inverseAt(other, at - 1) > inverseAt(face, at - 1) do at -= 1
          while at < last && inverseAt(other, at) <= inverseAt(face, at) do at += 1
          until = at
      i += 1
    until
