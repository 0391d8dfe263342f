package skein.signal

import skein.units.*

/** The delays of one direction of a link, given by the measured distribution of its round trips. One
  * direction takes half of a sampled round trip. The two directions sample independently, so that a round
  * trip spreads less than what was measured, by a factor of √2; under [[LatencyProfile.Correlated]] it
  * spreads as measured.
  */
enum LatencyProfile:

  /** Successive round trips are independent and their distribution never changes. */
  case Steady(name: String, roundTrip: LatencyDistribution)

  /** A link that is busy for a while and then quiet for a while; the lengths of these stretches are
    * exponentially distributed around `busyLasts` and `quietLasts`. Within a stretch successive round trips
    * are independent.
    */
  case Alternating(
      name: String,
      busy: LatencyDistribution,
      quiet: LatencyDistribution,
      busyLasts: Span,
      quietLasts: Span
  )

  /** Another profile whose delays persist for a while: the share p at which its distribution is read is
    * redrawn after exponentially distributed times of mean `over`, simultaneously for both directions and all
    * connections of a link. Every delay is distributed as before, and the correlation of p at two moments is
    * e^(−t/over): a round trip much shorter than `over` takes as long as one that was measured.
    */
  case Correlated(name: String, latency: LatencyProfile, over: Span)

  /** Another profile behind a line of limited rate, where bytes wait. */
  case Limited(name: String, latency: LatencyProfile, rate: Bandwidth)

  /** The text that [[LatencyProfile.parse]] reads back as this profile. */
  def name: String

  /** The mean round trip over a long time, without waits for a limited rate. */
  def mean: Span = this match
    case Steady(_, roundTrip)                               => roundTrip.mean
    case Alternating(_, busy, quiet, busyLasts, quietLasts) =>
      val share = busyLasts.toSeconds / (busyLasts + quietLasts).toSeconds
      Span.ofMillis(busy.mean.toMillis * share + quiet.mean.toMillis * (1 - share))
    case Correlated(_, latency, _) => latency.mean
    case Limited(_, latency, _)    => latency.mean

object LatencyProfile:
  val none: LatencyProfile   = Steady("none", LatencyDistribution.Constant(Span.Zero))
  val direct: LatencyProfile = Steady("direct", LatencyDistribution.Direct)
  val vpn: LatencyProfile    = Steady("vpn", LatencyDistribution.Vpn)

  /** The paper's VPN over a long time: busy in 393 of 935 samples, else like the direct link. It was measured
    * once, one stretch of each, so only the shares are its own; that a pair of stretches takes 95 s is our
    * choice.
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
    * (round trips in ms, one a line; empty lines and lines that start with # are skipped). All times are
    * round trips; units are `us`, `ms`, `s`. Before any of them may stand `correlated:250ms,` and before all
    * that `rate:50mbit,` or `rate:50mbit/64kB,`: see [[Bandwidth.parse]].
    *
    * @param read returns the text of the file at a path, or why it cannot
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

    text match
      case s"rate:$rate,$rest" =>
        for
          bandwidth <- Bandwidth.parse(rate).left.map(_ => malformed(Bandwidth.form, rate))
          latency   <- parse(rest, read)
          _         <- latency match
            case _: LatencyProfile.Limited => Left(malformed("one rate", rest))
            case _                         => Right(())
        yield LatencyProfile.Limited(text, latency, bandwidth)
      case s"rate:$came"             => Left(malformed("a rate and a profile such as 50mbit,direct", came))
      case s"correlated:$over,$rest" =>
        for
          mean    <- time(over).filterOrElse(_ > Span.Zero, malformed("more than 0", over))
          latency <- parse(rest, read)
          _       <- latency match
            case _: LatencyProfile.Limited    => Left(malformed("the rate before all else", rest))
            case _: LatencyProfile.Correlated => Left(malformed("one time constant", rest))
            case _                            => Right(())
        yield LatencyProfile.Correlated(text, latency, mean)
      case s"correlated:$came"      => Left(malformed("a time and a profile such as 250ms,direct", came))
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

  private def samples(path: String, content: String): Either[LatencyError, Vector[Double]] =
    val lines = content.linesIterator.map(_.trim).zipWithIndex.filterNot: (line, _) =>
      line.isEmpty || line.startsWith("#")
    Expect
      .each(lines): (line, index) =>
        line.toDoubleOption.filter(ms => ms >= 0 && ms <= 3_600_000).toRight(BadSample(path, index + 1, line))
      .filterOrElse(_.nonEmpty, NoSamples(path))

  private val time = """\s*(\d+(?:\.\d+)?)\s*(us|ms|s)\s*""".r

  /** Reads a time of at most an hour; a longer round trip is a mistake. */
  private def span(text: String): Option[Span] = text match
    case time(number, unit) =>
      val ms = unit match
        case "us" => number.toDouble / 1000
        case "ms" => number.toDouble
        case _    => number.toDouble * 1000
      Option.when(ms <= 3_600_000)(Span.ofMillis(ms))
    case _ => None
