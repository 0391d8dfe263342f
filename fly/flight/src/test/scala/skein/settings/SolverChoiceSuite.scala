package skein.settings

import skein.link.Address
import skein.signal.LatencyProfile

class SolverChoiceSuite extends munit.FunSuite:

  test("a choice of solver is read from its text, and written as that text"):
    for
      (text, choice) <- Seq(
        "tcp://lab:7400"         -> SolverChoice.Tcp(Address("lab", 7400)),
        "kafka://lab:9092/a.b-2" -> SolverChoice.Kafka(Address("lab", 9092), "a.b-2"),
        "link:vpn"               -> SolverChoice.Link(LatencyProfile.vpn)
      )
    do
      assertEquals(SolverChoice.parse(text), Right(choice))
      assertEquals(choice.text, text)

  test("an invalid text is refused, with what was expected and given"):
    val forms = "expected tcp://HOST:PORT, kafka://HOST:PORT/PREFIX or link:PROFILE, got "
    for
      (text, expected) <- Seq(
        "lab:7400"             -> s"$forms'lab:7400'",
        "tcp://lab"            -> s"$forms'tcp://lab': ",
        "kafka://lab/x"        -> s"$forms'kafka://lab/x': ",
        "kafka://lab:9092"     -> s"$forms'kafka://lab:9092'",
        "kafka://lab:9092/ä"   -> "expected a PREFIX of topics of letters, digits, '.', '_' and '-', got 'ä'",
        "kafka://lab:9092/"    -> "expected a PREFIX of topics of letters, digits, '.', '_' and '-', got ''",
        "link:slow"            -> "unknown latency profile \"slow\"; expected none, direct, ",
        "pekko://system@lab:1" -> s"$forms'pekko://system@lab:1': solvers speak a protocol of their own"
      )
    do assert(clue(SolverChoice.parse(text)).left.exists(_.startsWith(expected)), text)
