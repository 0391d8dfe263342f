package skein.bench

/** The work of [[ChauffeurKernel]], one world at a time, in plain Scala and doubles. */
object ChauffeurScalar:
  private val TickS  = 0.1
  private val Keep   = math.exp(-TickS / 0.5)
  private val Gain   = 0.5 * (1 - Keep)
  private val Radius = 8.0

  /** Runs blocks of worlds; see `ChauffeurKernel.run`. */
  def run(thread: Int, blocks: Int): Double =
    val history = Array.ofDim[Double](4, 4) // evader x, y, pursuer x, y before each of the last ticks
    var total   = 0.0
    for world <- 0 until blocks * ChauffeurKernel.BLOCK do total += fly(thread * 7919 + world, world, history)
    total

  private def fly(number: Int, world: Int, history: Array[Array[Double]]): Double =
    var bits               = (1234567 + number * 0x9e3779b1) | 1
    val turn               = (0.04 + 0.001 * (world % ChauffeurKernel.BLOCK)) * 10 / Radius
    var ex                 = 21.0
    var ey, px, py         = 0.0
    var evx, evy, pvx, pvy = 0.0
    var pursuerHeading     = 0.0
    var least              = 1e9
    var sum                = 0.0
    for row <- history do
      row(0) = ex; row(1) = 0; row(2) = 0; row(3) = 0
    for tick <- 0 until ChauffeurKernel.TICKS do
      bits ^= bits << 13
      bits ^= bits >>> 17
      bits ^= bits << 5
      val age           = 0.2 + 1.8 * (bits >>> 8) / 16777216.0
      val whole         = if age >= 1 then 1 else 0
      val share         = age - whole
      val (a, b)        = (history(tick - whole & 3), history(tick - whole - 1 & 3))
      val dx            = a(0) + (b(0) - a(0)) * share - (a(2) + (b(2) - a(2)) * share)
      val dy            = a(1) + (b(1) - a(1)) * share - (a(3) + (b(3) - a(3)) * share)
      val cos           = math.cos(pursuerHeading)
      val sin           = math.sin(pursuerHeading)
      val x             = dx * cos + dy * sin
      val y             = dy * cos - dx * sin
      val evaderHeading =
        if x * x + (y - Radius) * (y - Radius) < Radius * Radius then
          pursuerHeading + math.atan2(y + Radius, x)
        else if x * x + (y + Radius) * (y + Radius) < Radius * Radius then
          pursuerHeading + math.atan2(y - Radius, x)
        else if x * x + y * y < 4 * Radius * Radius then pursuerHeading + math.atan2(y, x) + math.Pi / 2
        else pursuerHeading + math.atan2(y, x)
      pursuerHeading += math.signum(y) * turn
      val (ewx, ewy) = (5 * math.cos(evaderHeading), 5 * math.sin(evaderHeading))
      val (pwx, pwy) = (10 * math.cos(pursuerHeading), 10 * math.sin(pursuerHeading))
      ex += ewx * TickS + (evx - ewx) * Gain; ey += ewy * TickS + (evy - ewy) * Gain
      px += pwx * TickS + (pvx - pwx) * Gain; py += pwy * TickS + (pvy - pwy) * Gain
      evx = ewx + (evx - ewx) * Keep; evy = ewy + (evy - ewy) * Keep
      pvx = pwx + (pvx - pwx) * Keep; pvy = pwy + (pvy - pwy) * Keep
      val row = history(tick + 1 & 3)
      row(0) = ex; row(1) = ey; row(2) = px; row(3) = py
      val distance = math.sqrt((ex - px) * (ex - px) + (ey - py) * (ey - py))
      least = math.min(least, distance)
      sum += distance
    least + sum / ChauffeurKernel.TICKS
