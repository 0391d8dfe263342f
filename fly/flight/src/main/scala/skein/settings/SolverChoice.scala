package skein.settings

import skein.link.Address
import skein.signal.LatencyProfile

/** Where decisions are made, if not in this process. */
enum SolverChoice:
  /** A solver that listens at an address. */
  case Tcp(at: Address)

  /** A solver behind a Kafka broker, over two topics whose names begin with `prefix`. */
  case Kafka(broker: Address, prefix: String)

  /** A solver behind a link of this profile: for flights in virtual time. */
  case Link(profile: LatencyProfile)

  def text: String = this match
    case Tcp(at)               => s"tcp://$at"
    case Kafka(broker, prefix) => s"kafka://$broker/$prefix"
    case Link(profile)         => s"link:${profile.name}"

object SolverChoice:
  private val Expected = "tcp://HOST:PORT, kafka://HOST:PORT/PREFIX or link:PROFILE"

  /** Reads the user's text.
    *
    * @param expected the error's description of valid texts
    */
  def parse(text: String, expected: String = Expected): Either[String, SolverChoice] = text match
    case s"tcp://$at"               => address(at, text, expected).map(Tcp(_))
    case s"kafka://$broker/$prefix" =>
      for
        at   <- address(broker, text, expected)
        name <- Either.cond(
          prefix.matches("[A-Za-z0-9._-]{1,100}"),
          prefix,
          s"expected a PREFIX of topics of letters, digits, '.', '_' and '-', got '$prefix'"
        )
      yield Kafka(at, name)
    case s"link:$profile" => LinkText.profile(profile).map(Link(_))
    case s"pekko://$_"    =>
      Left(
        s"expected $expected, got '$text': solvers speak a " +
          "protocol of their own over TCP, not Pekko's remoting"
      )
    case _ => Left(s"expected $expected, got '$text'")

  private def address(text: String, whole: String, expected: String): Either[String, Address] =
    Address.parse(text).left.map(why => s"expected $expected, got '$whole': $why")
