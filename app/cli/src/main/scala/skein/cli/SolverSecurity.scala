package skein.cli

import java.io.{IOException, StringReader}
import java.nio.file.{Files, Path}
import java.util.Properties
import javax.net.ssl.SSLContext
import mainargs.{ParserForClass, arg}
import scala.jdk.CollectionConverters.*
import skein.cluster.Tls
import skein.kafka.KafkaCertificates
import skein.settings.SolverChoice
import skein.units.Expect

/** Options for mutual authentication of a flight and its solver. */
final case class SolverSecurity(
    @arg(doc =
      "for a solver or a Kafka broker of another machine: folder of ./skein " +
        "cluster with this machine's certificate; without it, loopback alone"
    )
    tls: Option[String],
    @arg(doc =
      "instead of --tls, for a Kafka broker with other certificates, or with " +
        "passwords: file with its clients' security.protocol, ssl.… and sasl.…"
    )
    kafkaSecurity: Option[String]
):
  import SolverSecurity.*

  /** @return Left says which option a connection to such a solver lacks, or does not accept */
  def checked(way: Option[SolverChoice]): Either[String, Checked] = way match
    case Some(SolverChoice.Tcp(at)) =>
      for
        _ <- Expect.that(kafkaSecurity.isEmpty):
          s"--kafka-security: expected with a solver behind a Kafka broker, got with tcp://$at"
        read <- tls match
          case Some(folder) => Tls.of(Path.of(folder)).flatMap(_.context).map(Some(_))
          case None         =>
            Either.cond(
              at.isLoopback,
              None,
              s"--tls: expected certificates of both sides where the solver at $at is reached " +
                "by other machines; ./skein cluster certificates FOLDER makes a lab's. Without " +
                "them it is of this machine alone, such as tcp://127.0.0.1:7400"
            )
      yield Checked(read, Map.empty)
    case Some(SolverChoice.Kafka(broker, _)) =>
      for
        read <- (tls, kafkaSecurity) match
          case (Some(folder), None) => Tls.of(Path.of(folder)).flatMap(ofKafka)
          case (None, Some(file))   => properties(Path.of(file))
          case (Some(_), Some(_))   =>
            Left("--tls, --kafka-security: expected one of them; the file says whom to trust, too")
          case (None, None) =>
            Either.cond(
              broker.isLoopback,
              Map.empty[String, String],
              s"--tls: expected certificates where the Kafka broker at $broker is of " +
                "another machine; ./skein cluster certificates FOLDER makes a lab's, and " +
                "--kafka-security FILE tells of others. Without them the broker is of " +
                "this machine alone, such as kafka://127.0.0.1:9092/PREFIX"
            )
      yield Checked(None, read)
    case Some(SolverChoice.Link(_)) | None =>
      Either.cond(
        tls.isEmpty && kafkaSecurity.isEmpty,
        Checked(None, Map.empty),
        "--tls, --kafka-security: expected with a solver at tcp://HOST:PORT or kafka://HOST:PORT/PREFIX"
      )

object SolverSecurity:
  given ParserForClass[SolverSecurity] = ParserForClass[SolverSecurity]

  /** @param certificates the certificates for a solver behind TCP
    * @param kafka settings of Kafka's clients
    */
  final case class Checked(certificates: Option[SSLContext], kafka: Map[String, String])

  /** Kafka's settings with these certificates, after checking that they are readable. */
  private def ofKafka(tls: Tls): Either[String, Map[String, String]] =
    tls.context.map(_ => KafkaCertificates.settings(tls.keyStore, tls.trustStore, tls.password))

  private val Kinds = Seq("security.", "ssl.", "sasl.")

  private[cli] def properties(file: Path): Either[String, Map[String, String]] =
    def wrong(reason: String) = Left(s"--kafka-security: $reason in $file")
    try
      val read = Properties()
      read.load(StringReader(Files.readString(file)))
      val all = read.asScala.toMap
      all.keys.find(key => !Kinds.exists(key.startsWith(_))) match
        case Some(other) => wrong(s"expected ${Kinds.mkString("…, ")}…, got '$other'")
        case None if !all.contains("security.protocol") =>
          wrong("expected security.protocol, for example SSL,")
        case None => Right(all)
    catch
      case failed: (IOException | IllegalArgumentException) =>
        Left(s"--kafka-security: cannot read $file: ${failed.getMessage}")
