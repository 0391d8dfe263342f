package skein.cli

import mainargs.{Leftover, ParserForClass, arg}
import skein.cluster.Certificates

/** Command-line options of `./skein cluster`, with their help texts. */
final case class ClusterCommandOptions(
    @arg(doc =
      "name of a machine, to stand in its certificate: a host name, an address, or " +
        "*.DOMAIN for all of a domain; can be repeated (default: localhost)"
    )
    host: Seq[String],
    @arg(doc =
      "makes certificates, with a folder for each host"
    )
    words: Leftover[String]
)

/** `./skein cluster certificates`: makes the certificates with which machines authenticate each other. */
object ClusterCommand
    extends Command[ClusterCommandOptions](
      "cluster",
      "makes certificates for searches and solvers on several machines",
      ParserForClass[ClusterCommandOptions]
    ):

  protected def execute(options: ClusterCommandOptions): Either[String, Unit] = options.words.value match
    case Seq("certificates", text) =>
      val hosts = if options.host.isEmpty then Seq("localhost") else options.host.distinct
      for
        _      <- Certificates.checked(hosts).left.map("--host: " + _)
        folder <- OutFolder.made("certificates", text)
        made   <- Certificates.make(folder, hosts)
      yield
        Console.out.println(s"written: ${made.mkString(", ")}")
        Console.out.println(
          "Copy each folder to its machine alone. Who has " +
            s"$folder/signer.p12 and its password can make more."
        )
    case words =>
      val came = if words.isEmpty then "nothing" else words.mkString("'", " ", "'")
      Left(s"expected ./skein cluster certificates FOLDER, got $came")
