package skein.cli

import java.nio.file.Path
import mainargs.{ParserForClass, arg}
import skein.cluster.Tls
import skein.link.Address
import skein.search.SearchBlock
import skein.units.Expect

/** Options that distribute a computation to other processes. */
final case class ClusterOptions(
    @arg(doc = "computes with this many processes of this machine, which share its cores")
    workers: Option[Int],
    @arg(doc =
      "where workers of other machines join (./skein worker --join); the command waits for them"
    )
    cluster: Option[String],
    @arg(doc =
      "approximate number of episodes or flights in a block of work (default: those of half a second)"
    )
    block: Option[Int],
    @arg(doc = "folder of ./skein cluster with this machine's certificate; without it, loopback alone")
    tls: Option[String]
):
  import ClusterOptions.*

  /** The validated options; None if this process computes alone. */
  def checked: Either[String, Option[ClusterOptions.Checked]] =
    if workers.isEmpty && cluster.isEmpty then
      Either.cond(
        block.isEmpty && tls.isEmpty,
        None,
        "--block, --tls: expected with --workers or --cluster"
      )
    else
      for
        _      <- Expect.optional(workers)(Expect.within("--workers", _, 1, MostWorkers))
        _      <- Expect.optional(block)(Expect.within("--block", _, 1, SearchBlock.MostEpisodes))
        listen <- cluster.fold(Right(Loopback))(endpoint("--cluster", _))
        tls    <- Expect.optional(tls)(folder => Tls.of(Path.of(folder)))
      yield Some(Checked(workers.getOrElse(0), listen, block, tls))

object ClusterOptions:
  given ParserForClass[ClusterOptions] = ParserForClass[ClusterOptions]

  final case class Checked(
      workers: Int,
      listen: Address,
      block: Option[Int],
      tls: Option[Tls]
  )

  private val MostWorkers = 256

  /** Any free port, which only this machine can reach. */
  val Loopback: Address = Address("127.0.0.1", 0)

  def endpoint(option: String, text: String): Either[String, Address] =
    Address.parse(text).left.map(s"$option: " + _)
