"""Friction and a late sensor on the machine, neither in its MuJoCo model: which is named?

    pip install mujoco
    python crates/python/examples/mujoco_arm.py

An arm of two links swings in a plane. A motor at the shoulder drives it; the angles of both joints are measured, the
second one 8 ms late, and the elbow rubs. The records are made by MuJoCo too, with a fortieth of the step and its own
friction, which the model that is asked does not have.
"""

import time

import mujoco
import numpy as np

import simgap

STEP, SAMPLES = 6e-3, 400
FRICTION, LATE = 0.05, 8e-3  # N m, s

MODEL = """
<mujoco>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 -9.81"/>
  <worldbody>
    <body name="upper">
      <joint name="shoulder" axis="0 1 0" damping="0.05"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.02" mass="0.8" contype="0" conaffinity="0"/>
      <body name="lower" pos="0 0 -0.3">
        <joint name="elbow" axis="0 1 0" damping="0.02" frictionloss="{friction}"/>
        <geom name="lower" type="capsule" fromto="0 0 0 0 0 -0.25" size="0.02" mass="0.4" contype="0"
              conaffinity="0"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="motor" joint="shoulder"/></actuator>
</mujoco>
"""

# A few rivals, to be quick. The whole catalogue takes many times as many simulations.
SUSPECTED = {"parameter_error", "coulomb_friction", "viscous_damping", "sensor_delay", "input_delay"}


def stepped(model, data, torque, forces, every=1):
    """Angles and velocities of both joints at the samples, from hanging at rest; `every` steps to a sample."""
    mujoco.mj_resetData(model, data)
    q, v = np.empty((len(torque), 2)), np.empty((len(torque), 2))
    for n, (u, pushed) in enumerate(zip(torque, forces)):
        q[n], v[n] = data.qpos, data.qvel
        data.ctrl[0] = u
        data.qfrc_applied[:] = pushed
        for _ in range(every):
            mujoco.mj_step(model, data)
    return q, v


class Arm:
    """The model that is asked, `f(parameters, inputs, forces) -> outputs`."""

    def __init__(self):
        self.model = mujoco.MjModel.from_xml_string(MODEL.format(step=STEP, integrator="RK4", friction=0.0))
        self.data = mujoco.MjData(self.model)
        self.lower = self.model.body("lower").id
        self.nominal = self.model.body_mass[self.lower], self.model.body_inertia[self.lower].copy()
        self.calls = 0

    def __call__(self, parameters, inputs, forces):
        self.calls += 1
        mass, inertia = self.nominal
        self.model.body_mass[self.lower] = parameters["lower_mass"]
        self.model.body_inertia[self.lower] = inertia * parameters["lower_mass"] / mass
        self.model.dof_damping[:] = parameters["shoulder_damping"], parameters["elbow_damping"]
        mujoco.mj_setConst(self.model, self.data)
        pushed = np.column_stack([forces["shoulder"], forces["elbow"]])
        q, v = stepped(self.model, self.data, inputs["torque"], pushed)
        return {"q1": q[:, 0], "q2": q[:, 1], "v1": v[:, 0], "v2": v[:, 1]}


def record(k):
    """A record of the machine."""
    text = MODEL.format(step=STEP / 40, integrator="implicitfast", friction=FRICTION)
    machine = mujoco.MjModel.from_xml_string(text)
    rng = np.random.default_rng(k)
    t = STEP * np.arange(SAMPLES)
    tones = zip([0.3, 0.9, 1.6], [0.5, 0.4, 0.3], rng.uniform(0.0, 2.0 * np.pi, 3))
    torque = (1.0 - np.exp(-2.0 * t)) * sum(a * np.sin(2 * np.pi * f * t + p) for f, a, p in tones)
    q, _ = stepped(machine, mujoco.MjData(machine), torque, np.zeros((SAMPLES, 2)), every=40)
    q[:, 1] = np.interp(t - LATE, t, q[:, 1])
    q += rng.normal(0.0, 2e-4, q.shape)
    columns = {"t": t, "torque": torque, "q1": q[:, 0], "q2": q[:, 1]}
    return simgap.Record(columns, {"torque": "N m", "q1": "rad", "q2": "rad"}, name=f"run{k}")


def main():
    arm = Arm()
    simulator = simgap.Simulator(
        arm,
        inputs=["torque"],
        outputs=["q1", "q2"],
        parameters={"lower_mass": 0.4, "shoulder_damping": (0.05, 0.1), "elbow_damping": (0.02, 0.1)},
        ports={"shoulder": ("q1", "v1"), "elbow": ("q2", "v2")},
        name="arm in MuJoCo",
    )
    runs = [record(k) for k in range(3)]
    begun = time.perf_counter()
    others = [kind for kind in simgap.effects() if kind not in SUSPECTED]
    d = simgap.diagnose(simulator=simulator, train=runs[:2], check=runs[2], withhold=others, budget_s=120)
    print(d)
    print(f"{arm.calls} simulations, {time.perf_counter() - begun:.0f} s")
    d.save("mujoco-arm")


if __name__ == "__main__":
    main()
