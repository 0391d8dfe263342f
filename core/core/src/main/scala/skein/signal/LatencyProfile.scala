package skein.signal

import skein.units.*

/** The delays of one direction of a link, given by the measured distribution of its round trips. A delay is
  * half of a sampled round trip. The two directions sample independently, so that round trips spread less
  * than measured, by a factor of √2; under [[LatencyProfile.Correlated]] they spread as measured.
  */
enum LatencyProfile:

  /** Successive round trips are independent and their distribution never changes. */
  case Steady(name: String, roundTrip: LatencyDistribution)

  /** A link that alternates between busy and quiet stretches. Their durations are exponentially distributed,
    * with means `busyLasts` and `quietLasts`. Within a stretch, successive round trips are independent.
    */
  case Alternating(
      name: String,
      busy: LatencyDistribution,
      quiet: LatencyDistribution,
      busyLasts: Span,
      quietLasts: Span
  )

  /** Another profile whose delays persist for a while: the probability p at which its quantile is read is
    * redrawn after exponentially distributed times with mean `over`, simultaneously for both directions and
    * all connections of a link. The distribution of each delay is unchanged, and the correlation of p at two
    * moments is e^(−t/over). So a round trip much shorter than `over` is distributed like the measured ones.
    */
  case Correlated(name: String, latency: LatencyProfile, over: Span)

  /** Another profile behind a line of limited rate, at which bytes wait. */
  case Limited(name: String, latency: LatencyProfile, rate: Bandwidth)

  /** Another profile that also loses or reorders packets. */
  case Impaired(name: String, latency: LatencyProfile, by: Impairment)

  /** The text that [[LatencyProfile.parse]] reads back as this profile. */
  def name: String

  /** The rate of the line and its queue, if the rate is limited. */
  def bandwidth: Option[Bandwidth] = this match
    case Limited(_, _, rate) => Some(rate)
    case _                   => within.flatMap(_.bandwidth)

  /** The losses and reordering of packets, the outermost profile's first; empty if there are none. */
  def impairments: Vector[Impairment] = this match
    case Impaired(_, latency, by) => by +: latency.impairments
    case _                        => within.fold(Vector.empty)(_.impairments)

  /** The profile of the delays alone, without rate and losses. */
  def delays: LatencyProfile = this match
    case Limited(_, latency, _)                                       => latency.delays
    case Impaired(_, latency, _)                                      => latency.delays
    case Correlated(name, latency, over) if latency.delays != latency =>
      Correlated(name, latency.delays, over)
    case _ => this

  private[signal] def within: Option[LatencyProfile] = this match
    case Steady(_, _) | Alternating(_, _, _, _, _) => None
    case Correlated(_, latency, _)                 => Some(latency)
    case Limited(_, latency, _)                    => Some(latency)
    case Impaired(_, latency, _)                   => Some(latency)

  /** Mean round trip, without the time that bytes wait for the line, or that packets are sent again or late.
    */
  def meanRoundTrip: Span = Span.ofMillis(average(_.mean.toMillis))

  /** Mean deviation of round trips from their mean, E|t − E t|. */
  def meanDeviation: Span =
    val mean = meanRoundTrip.toMillis
    Span.ofMillis(average: distribution =>
      val parts = 1000
      (0 until parts).map(i => (distribution.quantile((i + 0.5) / parts).toMillis - mean).abs).sum / parts)

  private def average(of: LatencyDistribution => Double): Double = this match
    case Steady(_, roundTrip)                             => of(roundTrip)
    case Alternating(_, busy, quiet, busyLasts, notLasts) =>
      val share = busyLasts.toSeconds / (busyLasts.toSeconds + notLasts.toSeconds)
      share * of(busy) + (1 - share) * of(quiet)
    case _ => within.fold(0.0)(_.average(of))

object LatencyProfile:
  val none: LatencyProfile   = Steady("none", LatencyDistribution.Constant(Span.Zero))
  val direct: LatencyProfile = Steady("direct", LatencyDistribution.Direct)
  val vpn: LatencyProfile    = Steady("vpn", LatencyDistribution.Vpn)

  /** The paper's VPN over a long time: busy in 393 of 935 samples, otherwise like the direct link. It was
    * measured only once, with one stretch of each kind, so only the shares are measured; the mean duration of
    * a pair of stretches, 95 s, is an assumption.
    */
  val vpnMixed: Alternating = new Alternating(
    "vpn-mixed",
    busy = LatencyDistribution.Vpn,
    quiet = LatencyDistribution.Direct,
    busyLasts = Span.ofSeconds(40),
    quietLasts = Span.ofSeconds(55)
  )

  /** Reads a profile from its text form: `none`, `direct`, `vpn`, `vpn-mixed`, `constant:200ms`,
    * `uniform:10ms..40ms`, `lognormal:36ms,0.3` (median, standard deviation of the logarithm), `file:PATH`
    * (round trips in ms, one per line; empty lines and lines that start with # are skipped). All times are
    * round trips; units are `us`, `ms`, `s`. Any of these may be preceded by the following, each once and in
    * any order: `correlated:250ms,`; `rate:50mbit,` or `rate:50mbit/64kB,` ([[Bandwidth.parse]]); `loss:5%,`,
    * or `loss:5%/4,` in bursts of four packets on average ([[Impairment.Loss]]); `outage:1s/10s,`, for 1 s
    * every 10 s on average ([[Impairment.Outage]]); `reorder:2%/10ms,`, 10 ms later
    * ([[Impairment.Reordering]]).
    *
    * @param read returns the text of the file at a path, or why that fails
    */
  def parse(text: String, read: String => Either[String, String]): Either[LatencyError, LatencyProfile] =
    LatencyText.parse(text, read)

/** The text form of latency profiles, for flags and configuration files. */
private object LatencyText:
  import LatencyDistribution.*
  import LatencyError.*
  import LatencyProfile.Steady

  private val named =
    List(LatencyProfile.none, LatencyProfile.direct, LatencyProfile.vpn, LatencyProfile.vpnMixed)
      .map(profile => profile.name -> profile)
      .toMap

  def parse(text: String, read: String => Either[String, String]): Either[LatencyError, LatencyProfile] =
    def malformed(expected: String, came: String)      = Malformed(text, expected, came)
    def time(came: String): Either[LatencyError, Span] =
      span(came).toRight(malformed("a time such as 200ms", came))

    def before(rest: String, what: String)(isSame: LatencyProfile => Boolean) =
      parse(rest, read).filterOrElse(!layers(_).exists(isSame), malformed(s"one $what", rest))

    def impaired(what: String, form: String, rest: String)(read: String => Either[String, Impairment]) =
      for
        by      <- read(form).left.map(malformed(_, form))
        latency <- before(rest, what):
          case LatencyProfile.Impaired(_, _, other) => other.getClass == by.getClass
          case _                                    => false
      yield LatencyProfile.Impaired(text, latency, by)

    text match
      case s"rate:$rate,$rest" =>
        for
          bandwidth <- Bandwidth.parse(rate).left.map(_ => malformed(Bandwidth.form, rate))
          latency   <- before(rest, "rate")(_.isInstanceOf[LatencyProfile.Limited])
        yield LatencyProfile.Limited(text, latency, bandwidth)
      case s"rate:$came"             => Left(malformed("a rate and a profile such as 50mbit,direct", came))
      case s"correlated:$over,$rest" =>
        for
          mean    <- time(over).filterOrElse(_ > Span.Zero, malformed("more than 0", over))
          latency <- before(rest, "time constant")(_.isInstanceOf[LatencyProfile.Correlated])
        yield LatencyProfile.Correlated(text, latency, mean)
      case s"correlated:$came" => Left(malformed("a time and a profile such as 250ms,direct", came))
      case s"loss:$loss,$rest" =>
        impaired("loss", loss, rest)(Impairment.loss)
      case s"loss:$came" => Left(malformed("a share and a profile such as 5%,vpn or 5%/4,vpn", came))
      case s"outage:$outage,$rest" =>
        impaired("outage", outage, rest)(Impairment.outage(_, span))
      case s"reorder:$reorder,$rest" =>
        impaired("reorder", reorder, rest)(Impairment.reordering(_, span))
      case s"reorder:$came" => Left(malformed("a share, a delay and a profile such as 2%/10ms,vpn", came))
      case s"outage:$came"  => Left(malformed("two times and a profile such as 1s/10s,vpn", came))
      case s"constant:$roundTrip"   => time(roundTrip).map(t => Steady(text, Constant(t)))
      case s"uniform:$least..$most" =>
        for
          from  <- time(least)
          until <- time(most)
          _     <- Either.cond(from <= until, (), malformed("the smaller time first", s"$least..$most"))
        yield Steady(text, Uniform(from, until))
      case s"uniform:$came"            => Left(malformed("two times such as 10ms..40ms", came))
      case s"lognormal:$median,$sigma" =>
        for
          middle <- time(median)
          spread <- sigma.trim.toDoubleOption
            .filter(s => s >= 0 && s <= 3)
            .toRight(malformed("a standard deviation of the logarithm from 0 to 3", sigma))
        yield Steady(text, LogNormal(middle, spread))
      case s"lognormal:$came" =>
        Left(malformed("the median and the standard deviation of the logarithm such as 36ms,0.3", came))
      case s"file:$path" =>
        for
          content      <- read(path).left.map(Unreadable(path, _))
          roundTripsMs <- samples(path, content)
        yield Steady(text, ofSamples(roundTripsMs))
      case _ => named.get(text).toRight(UnknownProfile(text))

  private def layers(profile: LatencyProfile): Iterator[LatencyProfile] =
    Iterator.unfold(Option(profile))(_.map(layer => (layer, layer.within)))

  private def samples(path: String, content: String): Either[LatencyError, Vector[Double]] =
    val lines = content.linesIterator.map(_.trim).zipWithIndex.filterNot: (line, _) =>
      line.isEmpty || line.startsWith("#")
    Expect
      .each(lines): (line, index) =>
        line.toDoubleOption.filter(ms => ms >= 0 && ms <= 3_600_000).toRight(BadSample(path, index + 1, line))
      .filterOrElse(_.nonEmpty, NoSamples(path))

  private val time = """\s*(\d+(?:\.\d+)?)\s*(us|ms|s)\s*""".r

  /** Reads a time of up to an hour; a longer round trip is assumed to be a mistake. */
  private def span(text: String): Option[Span] = text match
    case time(number, unit) =>
      val ms = unit match
        case "us" => number.toDouble / 1000
        case "ms" => number.toDouble
        case _    => number.toDouble * 1000
      Option.when(ms <= 3_600_000)(Span.ofMillis(ms))
    case _ => None
