package skein.cli

import java.nio.file.Files
import skein.settings.SolverChoice
import skein.testing.TemporaryFolders

class SolverSecuritySuite extends munit.FunSuite, TemporaryFolders:

  private def way(text: String) = Some(SolverChoice.parse(text).fold(fail(_), identity))

  private def refused(at: String, tls: Option[String] = None, kafka: Option[String] = None): String =
    SolverSecurity(tls, kafka).checked(way(at)).swap.getOrElse(fail("was taken"))

  test("on loopback no security is required; beyond it TCP needs certificates, and Kafka its own settings"):
    for at <- Seq("tcp://127.0.0.1:7400", "tcp://localhost:1", "kafka://127.0.0.1:9092/skein", "link:direct")
    do
      assertEquals(
        SolverSecurity(None, None).checked(way(at)),
        Right(SolverSecurity.Checked(None, Map.empty)),
        at
      )
    for at <- Seq("tcp://192.0.2.1:7400", "tcp://0.0.0.0:7400") do
      assert(clue(refused(at)).startsWith("--tls: expected"))
    assert(clue(refused("kafka://192.0.2.1:9092/skein")).startsWith("--tls: expected"))

  test("options of another kind of solver are refused, and missing files are listed"):
    assert(clue(refused(
      "tcp://127.0.0.1:1",
      kafka = Some("f")
    )).contains("--kafka-security: expected with a solver behind a Kafka broker"))
    assert(clue(refused(
      "kafka://127.0.0.1:1/a",
      tls = Some("f"),
      kafka = Some("g")
    )).contains("expected one of them"))
    assert(clue(refused("kafka://192.0.2.1:1/a", tls = Some("no-such-folder"))).contains("no-such-folder"))
    assert(clue(refused("link:direct", tls = Some("f"))).contains("expected with a solver at"))
    assert(SolverSecurity(Some("f"), None).checked(None).isLeft)
    assert(clue(refused("tcp://192.0.2.1:1", tls = Some("no-such-folder"))).contains("no-such-folder"))
    assert(clue(refused("kafka://192.0.2.1:1/a", kafka = Some("no-such-file"))).contains("no-such-file"))

  folder.test("Kafka's security settings are used, and state the protocol"): folder =>
    def read(text: String) = SolverSecurity.properties(Files.writeString(folder.resolve("kafka"), text))
    assertEquals(
      read("# a broker's\nsecurity.protocol=SSL\nssl.truststore.location=/t.p12\n"),
      Right(Map("security.protocol" -> "SSL", "ssl.truststore.location" -> "/t.p12"))
    )
    assert(clue(read("security.protocol=SSL\nacks=0\n")).left.exists(_.contains("got 'acks'")))
    assert(clue(read("ssl.protocol=TLSv1.3\n")).left.exists(_.contains("expected security.protocol")))
    assert(clue(read("a=\\u00")).left.exists(_.contains("cannot read")))
