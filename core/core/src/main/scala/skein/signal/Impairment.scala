package skein.signal

import skein.units.*

/** A way in which a link loses or reorders packets. The effect depends on the transport: TCP sends a lost
  * packet again, and later bytes wait for it ([[Retransmission]]), as they wait for a late one; a datagram is
  * lost for good, and overtaken where it is late.
  */
enum Impairment:

  /** In each direction a share of all packets is lost, in bursts. The model is the chain of Gilbert,
    * "Capacity of a burst-noise channel", Bell System Technical Journal 39 (1960), which advances with every
    * packet of the direction, as `loss gemodel p r` of Linux's netem does. In its bad state every packet is
    * lost, in its good state none. It leaves the bad state with probability r = 1/burst, and enters it with p
    * = r · share / (1 − share). If `burst` is 1/(1 − share), losses are independent.
    *
    * @param burst mean number of successive packets that are lost, at least 1/(1 − share)
    */
  case Loss(share: Double, burst: Double)

  /** From time to time, nothing passes in either direction of any connection for `lasts`. The time between
    * two outages is exponentially distributed, so that outages begin `every` apart on average. A link begins
    * between two outages.
    */
  case Outage(lasts: Span, every: Span)

  /** In each direction a share of all packets, chosen independently, is on its way for `by` longer. Datagrams
    * sent less than `by` later overtake it, unless they are late themselves. It is then reordered as RFC 4737
    * counts. Linux's netem instead sends a share without delay, ahead of all others.
    */
  case Reordering(share: Double, by: Span)

object Impairment:
  private val MostShare = 0.9
  private val MostBurst = 10_000.0

  /** Independent losses of a share of all packets. */
  def independent(share: Double): Impairment = Loss(share, 1 / (1 - share))

  private val lossForm =
    s"a share from 0% to ${(MostShare * 100).toInt}% such as 5%, or with a mean length of bursts such as 5%/4"

  /** Reads `5%` or `5%/4`. Left says what was expected. */
  private[signal] def loss(text: String): Either[String, Impairment] =
    val (share, burst) = text match
      case s"$share/$burst" => (share, Some(burst))
      case share            => (share, None)
    for
      part <- percent(share).filter(p => p >= 0 && p <= MostShare).toRight(lossForm)
      loss <- burst match
        case None          => Right(independent(part))
        case Some(packets) =>
          val least = 1 / (1 - part)
          packets.toDoubleOption
            .filter(length => length >= least - 1e-9 && length <= MostBurst)
            .map(length => Loss(part, length.max(least)))
            .toRight(
              s"bursts of ${Decimals.fixed(least)(2)} packets, which independent losses have, to " +
                s"${MostBurst.toInt}"
            )
    yield loss

  /** Reads `1s/10s`: the duration, and the mean time between two begins. */
  private[signal] def outage(text: String, time: String => Option[Span]): Either[String, Impairment] =
    val times = text match
      case s"$lasts/$every" => time(lasts).zip(time(every))
      case _                => None
    for
      (lasts, every) <- times.toRight("two times such as 1s/10s")
      _              <- Expect.that(lasts > Span.Zero && lasts < every):
        "outages of more than 0, and longer times from one to the next"
    yield Outage(lasts, every)

  /** Reads `2%/10ms`: the share, and the additional delay. */
  private[signal] def reordering(text: String, time: String => Option[Span]): Either[String, Impairment] =
    val parts = text match
      case s"$share/$by" => percent(share).filter(p => p >= 0 && p <= 1).zip(time(by))
      case _             => None
    parts
      .collect { case (share, by) if by > Span.Zero => Reordering(share, by) }
      .toRight("a share and an additional delay such as 2%/10ms")

  def percent(text: String): Option[Double] = text match
    case s"$number%" => number.trim.toDoubleOption.map(_ / 100)
    case _           => None
