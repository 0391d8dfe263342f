package skein.cli

import mainargs.{Flag, arg}

/** Command-line options of `./skein observe`, with their help texts. */
final case class ObserveOptions(
    @arg(doc =
      "where the program connects, in place of the simulator; 0.0.0.0 opens it to other machines; without it, " +
        "127.0.0.1:41452, with --mavlink 127.0.0.1:14680"
    )
    listen: Option[String],
    @arg(doc =
      "the simulator: AirSim, one of its forks, or ./skein serve; with --mavlink a vehicle's UDP port, or " +
        "tcp://HOST:PORT; without it, 127.0.0.1:41451, with --mavlink 127.0.0.1:14580"
    )
    simulator: Option[String],
    @arg(doc = "the program speaks MAVLink 2, as to PX4, and not AirSim's protocol")
    mavlink: Flag,
    @arg(doc =
      "a network that is emulated between the program and the simulator: direct, vpn, constant:200ms, …"
    )
    link: String = ObserveOptions.Link,
    @arg(doc = "seed of every random choice")
    seed: Long = ObserveOptions.Seed,
    @arg(doc =
      "instead of a program: a bag of ROS 2, its folder or an MCAP file; the loop that it holds is measured"
    )
    bag: Option[String],
    @arg(doc =
      "instead of a simulator's wire: topics of a running graph of ROS 2, which must be installed; domain and " +
        "middleware are those of the environment"
    )
    ros: Flag,
    @arg(doc =
      "with --bag or --ros: a topic that vehicles are read by, for example /uav1/odom; can be repeated; " +
        "without it, topics of odometry and poses; with --mavlink a message, for example ATTITUDE; without it, " +
        "those of positions"
    )
    readings: Seq[String],
    @arg(doc =
      "with --bag or --ros: a topic of commands, for example /uav1/cmd_vel; can be repeated; without it, " +
        "topics of twists and poses named cmd, command, setpoint, target or goal"
    )
    commands: Seq[String],
    @arg(doc =
      "folder for observed.json with the tables, commands.csv with a row for each command, and the figure " +
        "ages.svg, ages.png; without it, the tables are only shown"
    )
    out: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag,
    view: ViewOptions,
    @arg(doc =
      "the program and its arguments, behind --: it is started, and observed until it ends; " +
        "without one, until Ctrl-C"
    )
    command: Behind
)

object ObserveOptions:
  private val Link = "none"
  private val Seed = 1L

  extension (options: ObserveOptions)
    /** Options of the connection to a simulator, which neither a bag nor topics have. */
    def ofWire: Vector[String] =
      Vector(
        "--listen"    -> options.listen.isDefined,
        "--simulator" -> options.simulator.isDefined,
        "--mavlink"   -> options.mavlink.value,
        "--link"      -> (options.link != Link),
        "--seed"      -> (options.seed != Seed)
      ).collect { case (name, true) => name }
