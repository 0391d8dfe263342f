package skein.figures

import skein.measure.{Distribution, FlightSet}
import skein.plot.*
import skein.signal.{LatencyDistribution, LatencyProfile}
import skein.units.Decimals.brief

/** The paper's Figure 3: histograms of round trips, one panel per link, with the density and the quantiles of
  * the link's profile, which for `direct` and `vpn` are the paper's own samples.
  */
object LatencyFigure:
  private val bar          = Colour(0x7aa6c2)
  private val profileLine  = Stroke(FlightTheme.published, 1.1)
  private val halvesLine   = Stroke(Colour(0xd55e00), 1.3)
  private val quantileLine = Stroke(FlightTheme.published.faded(0.6), 0.8, Vector(3, 2))

  /** One panel.
    *
    * @param title the title of the measurement
    * @param link the link whose profile is overlaid, if it has one
    */
  final case class Measured(title: String, link: String, roundTripsMs: Distribution)

  /** Draws one panel for each measurement, in order. */
  def apply(measured: Seq[Measured]): Option[Drawing] =
    Option.when(measured.nonEmpty):
      val panels = Drawing.grid(measured.map(panel), columns = 3.min(measured.size))
      Drawing.stacked(panels, legend(measured, panels.width - 52))

  def apply(set: FlightSet): Option[Drawing] =
    apply:
      for
        link    <- set.links
        samples <- Distribution.of(set.over(link).flatMap(_.roundTripsMs).flatMap(_.sorted))
        // In virtual flights without a network all round trips are equal.
        if samples.sorted.head < samples.sorted.last
      yield Measured(FlightTheme.link(link), link, samples)

  private def panel(measured: Measured): Drawing =
    val samples = measured.roundTripsMs
    val profile = profileOf(measured.link)
    val most    = axisEndMs(samples, profile)
    val step    = binWidthMs(most)
    val width   = BigDecimal(step).bigDecimal.stripTrailingZeros.toPlainString
    val bins    = samples.sorted.groupMapReduce(ms => math.floor(ms / step).toInt)(_ => 1)(_ + _)
    val share   = bins.view.mapValues(_ * 100.0 / samples.count).toMap
    val density = profile.toVector.flatMap(densityOf(_, step))
    val halves  = profile.toVector.flatMap(densityOfHalves(_, step))
    val panel   = Panel(
      PlotAxis.around("round trip, ms", 0, most, 6),
      PlotAxis.around(
        s"share per $width ms, %",
        0,
        (share.values ++ (density ++ halves).map(_._2)).max * 1.12
      ),
      left = 52,
      top = 48,
      width = 300,
      height = 170
    )
    val bars = share.toVector.sortBy(_._1).collect:
      case (bin, percent) if (bin + 1) * step <= panel.x.to + 1e-9 =>
        Mark.box(
          panel.atX(bin * step) + 0.5,
          panel.atY(percent),
          panel.atX((bin + 1) * step) - 0.5,
          panel.bottom,
          bar
        )
    val lines = Vector(density -> profileLine, halves -> halvesLine).collect:
      case (points, stroke) if points.nonEmpty => panel.curve(points, stroke)
    val marks = profile.toVector.flatMap(quantileMarks(panel, _))
    val facts = Vector(
      "mean"   -> samples.mean,
      "sd"     -> samples.sd,
      "median" -> samples.median,
      "p99"    -> samples.p99,
      "max"    -> samples.most
    ).map((name, ms) => s"$name ${ms.brief}").mkString(s"n ${samples.count}, ", ", ", " ms")
    val titles = Vector(
      panel.title(measured.title).moved(0, -14),
      Mark.Text(Point(panel.left, panel.top - 9), facts, Theme.tickSize)
    )
    Drawing(378, 268, titles ++ panel.axes ++ bars ++ lines ++ marks)

  /** End of the axis, ms. Round trips many times as long as the others, such as during a pause of the
    * process, lie beyond it and are only counted.
    */
  private def axisEndMs(samples: Distribution, profile: Option[LatencyDistribution]): Double =
    val longest = samples.most.min(1.25 * samples.p99)
    profile.fold(longest)(known => known.quantile(1).toMillis.max(longest))

  private def legend(measured: Seq[Measured], width: Double): Drawing =
    val profiles = measured.flatMap(one => profileOf(one.link))
    val items    = Seq(
      Some(Legend.box("measured", bar)),
      Option.when(profiles.exists(densityOf(_, step = 1).nonEmpty))(Legend.line(
        "the link's profile",
        profileLine
      )),
      Option.when(profiles.nonEmpty)(Legend.line("its quantiles", quantileLine)),
      Option.when(profiles.nonEmpty)(Legend.line("half of a sample each way, as emulated", halvesLine))
    ).flatten
    Legend.rows(52, width, items*)

  /** Marks of the profile's 5, 50 and 95 % quantiles. */
  private def quantileMarks(panel: Panel, profile: LatencyDistribution): Vector[Mark] =
    val anchors = Vector(0.05 -> Anchor.End, 0.5 -> Anchor.Middle, 0.95 -> Anchor.Start)
    anchors.flatMap: (p, anchor) =>
      val x = panel.atX(profile.quantile(p).toMillis)
      Vector(
        Mark.line(Point(x, panel.bottom), Point(x, panel.top + 13), quantileLine),
        Mark.Text(Point(x, panel.top + 9), s"${(p * 100).round} %", Theme.smallSize, anchor = anchor)
      )

  /** Density of the profile, per cent per bin, as a step line. */
  private def densityOf(profile: LatencyDistribution, step: Double): Vector[(Double, Double)] = profile match
    case LatencyDistribution.Quantiles(probabilities, roundTripsMs) =>
      val pieces = probabilities.zip(roundTripsMs).sliding(2).toVector.collect:
        case Vector((p0, t0), (p1, t1)) if t1 > t0 =>
          val percent = (p1 - p0) / (t1 - t0) * step * 100
          Vector((t0, percent), (t1, percent))
      ((roundTripsMs.head, 0.0) +: pieces.flatten) :+ (roundTripsMs.last, 0.0)
    case _ => Vector.empty

  /** Density of an emulated link's round trips: half of one sample forth, half of another back. */
  private def densityOfHalves(profile: LatencyDistribution, step: Double): Vector[(Double, Double)] =
    val count  = 400
    val halves = Vector.tabulate(count)(index => profile.quantile((index + 0.5) / count).toMillis / 2)
    val sums   = for there <- halves; back <- halves yield math.floor((there + back) / step).toInt
    sums
      .groupMapReduce(identity)(_ => 100.0 / (count * count))(_ + _)
      .toVector
      .sortBy(_._1)
      .map((bin, percent) => ((bin + 0.5) * step, percent))

  private def profileOf(link: String): Option[LatencyDistribution] =
    LatencyProfile.parse(link, _ => Left("not read for a picture")).toOption.collect:
      case LatencyProfile.Steady(_, roundTrip) if roundTrip.quantile(1) > roundTrip.quantile(0) => roundTrip

  /** A round bin width that gives about 40 bins. */
  private def binWidthMs(most: Double): Double =
    Seq(0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0).find(_ * 45 >= most).getOrElse(100)
