// SPDX-License-Identifier: MIT
// A stranger's controller: PD on the motors, against the messages alone. The law is in torque().
import java.util.TreeMap;
import lcm.lcm.LCM;
import mixloop_lcm.command_t;
import mixloop_lcm.reference_t;
import mixloop_lcm.sim_control_t;
import mixloop_lcm.state_t;

class Controller {
  static final double[] KP = {100, 25, 25}, KV = {1, 0.5, 0.5};

  static double torque(int i, double psi, double psid, double psiD, double psidD) {
    return KP[i] * (psiD - psi) + KV[i] * (psidD - psid);
  }

  final TreeMap<Long, reference_t> references = new TreeMap<>();
  state_t state; // the newest of the run that is followed
  boolean asked; // it waits for its answer
  boolean done;
  long heard; // when that run was heard, ns

  /** LCM's thread hears; the main thread answers, so that a slow law finds the newest state. */
  Controller(LCM bus) {
    bus.subscribe("MIXLOOP_(STATE|REFERENCE|SIM_CONTROL)", (lcm, channel, in) -> {
      try {
        if (channel.endsWith("_STATE")) take(new state_t(in));
        else if (channel.endsWith("_REFERENCE")) take(new reference_t(in));
        else take(new sim_control_t(in));
      } catch (java.io.IOException damaged) {
        System.err.println("dropped a message on " + channel);
      }
    });
  }

  synchronized void take(state_t message) {
    if (message.n != 3) return; // the law above is for three motors
    boolean ofThisRun = state != null && message.session == state.session;
    long now = System.nanoTime();
    // Another run on the same bus, unless ours has fallen silent.
    if (!ofThisRun && state != null && now - heard < 1_000_000_000L) return;
    heard = now;
    if (ofThisRun && message.seq < state.seq) return; // overtaken
    state = message;
    asked = true;
    notifyAll();
  }

  synchronized void take(reference_t reference) {
    if (reference.n != 3 || state != null && reference.session != state.session) return;
    references.put(reference.seq, reference);
    references.headMap(reference.seq - 10).clear();
    notifyAll();
  }

  synchronized void take(sim_control_t control) {
    if (control.action != sim_control_t.ACTION_END || state == null || control.session != state.session) return;
    done = true;
    notifyAll();
  }

  record Question(state_t state, reference_t desired) {}

  /** Waits for the newest state and its reference; null when the run is over. */
  synchronized Question next() throws InterruptedException {
    for (; !done; wait()) {
      reference_t desired = asked ? references.get(state.seq) : null;
      if (desired == null || desired.session != state.session) continue;
      asked = false;
      return new Question(state, desired);
    }
    return null;
  }

  /** STATE(k) by COMMAND(k). */
  static command_t answer(state_t state, reference_t desired) {
    command_t command = new command_t();
    command.n = state.n;
    command.utime = state.utime;
    command.seq = state.seq;
    command.session = state.session;
    command.config = state.config;
    command.tau_commanded = new double[state.n];
    for (int i = 0; i < state.n; ++i)
      command.tau_commanded[i] = torque(i, state.psi_measured[i], state.psid_measured[i],
                                        desired.psi_desired[i], desired.psid_desired[i]);
    return command;
  }

  public static void main(String[] arguments) throws Exception {
    String url = System.getenv("LCM_DEFAULT_URL");
    LCM bus = new LCM(url != null ? url : "udpm://239.255.76.67:7667?ttl=0");
    Controller controller = new Controller(bus);
    command_t command = null;
    for (Question asked = controller.next(); asked != null; asked = controller.next()) {
      state_t state = asked.state;
      // A repeated state gets the same bytes.
      if (command == null || command.session != state.session || command.seq != state.seq)
        command = answer(state, asked.desired);
      bus.publish("MIXLOOP_COMMAND", command);
    }
    System.exit(0);
  }
}
